/// \file velodyne_calibration.h
/// The calibration of a Velodyne HDL-64's lasers, as its maker (db.xml) and the ROS driver (YAML) write it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace pcl_floam {

inline constexpr std::size_t kHdl64Lasers = 64;

/// What the manual calls the corrections of one laser.
struct LaserCorrection {
  double rotation = 0.0;             ///< rad; how much farther to the left than the head it points
  double elevation = 0.0;            ///< rad
  double distance = 0.0;             ///< m to add to what is measured, far off
  std::optional<double> distance_x;  ///< the same for the coordinate to the right, near by; nothing: as far off
  std::optional<double> distance_y;  ///< and for that to the front
  double vertical_offset = 0.0;      ///< m; how far above the sensor's middle the beam passes, across the beam
  double horizontal_offset = 0.0;    ///< m; how far to the left of it
  std::uint16_t ring = 0;            ///< from below
};

struct VelodyneCalibration {
  std::array<LaserCorrection, kHdl64Lasers> lasers;
  double distance_unit = 0.002;  ///< m; that of the models S2 and S3
};

/// \throws FileError if it is neither of both formats, its library was left out of this build, or it does not give
///         believable corrections of all 64 lasers.
[[nodiscard]] VelodyneCalibration readVelodyneCalibration(const std::filesystem::path& file);

/// A point of one return: x forward, y left, z up, in m.
struct LaserPoint {
  double x, y, z;
};

/// What the manual's formulas make of a return. \param azimuth rad, clockwise from above
/// \param distance m, as measured
[[nodiscard]] LaserPoint calibratedPoint(const LaserCorrection& laser, double azimuth, double distance);

}  // namespace pcl_floam
