/// \file sensor_model.h
/// The beams of known lidars.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam {

/// A lidar: its beams' elevations, if it has beams that turn.
struct SensorModel {
  std::string name = "auto";      ///< "auto" when nothing is known about the sensor
  std::vector<float> elevations;  ///< rad above the horizontal, rising; empty where they are not known
  bool has_scan_lines = true;     ///< whether they are looked for
};

/// The model of a sensor by name: auto, solid-state (without scan lines), vlp16, vlp32c, hdl32, hdl64, os32, os64,
/// os128 (OS1; also os0-32 to os2-128), pandarxt16, pandarxt32. Elevations are the nominal values of the makers'
/// manuals.
/// \throws std::invalid_argument for an unknown name; the message lists the known ones.
[[nodiscard]] SensorModel sensorModel(std::string_view name);

/// The names that \ref sensorModel knows.
[[nodiscard]] std::vector<std::string> sensorNames();

/// A sensor of the user's own.
/// \param elevations_degrees one per beam, in any order
/// \throws std::invalid_argument if it has fewer than 2 or more than 1024 beams, or one is not within [-90, 90].
[[nodiscard]] SensorModel customSensor(std::string name, const std::vector<float>& elevations_degrees);

}  // namespace pcl_floam
