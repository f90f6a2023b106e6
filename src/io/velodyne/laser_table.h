/// \file laser_table.h
/// The numbers of a calibration file, whatever its format, on their way to a VelodyneCalibration.
#pragma once

#include "io/velodyne/velodyne_calibration.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam {

/// One laser's numbers by their names in the ROS driver's YAML, in rad and m.
using LaserNumbers = std::map<std::string, double, std::less<>>;

/// What a file holds.
struct LaserTable {
  std::vector<LaserNumbers> lasers;
  std::optional<double> distance_unit;  ///< m
};

/// A number of db.xml: its element, the name in the YAML, and what makes rad or m of it.
struct LaserNumber {
  const char* xml;
  const char* yaml;
  double factor;
  bool is_required;
};

inline constexpr double kRadiansPerDegree = 0.017453292519943295;
inline constexpr double kMetresPerCentimetre = 0.01;

inline constexpr LaserNumber kLaserNumbers[] = {
    {"rotCorrection_", "rot_correction", kRadiansPerDegree, true},
    {"vertCorrection_", "vert_correction", kRadiansPerDegree, true},
    {"distCorrection_", "dist_correction", kMetresPerCentimetre, true},
    {"distCorrectionX_", "dist_correction_x", kMetresPerCentimetre, false},
    {"distCorrectionY_", "dist_correction_y", kMetresPerCentimetre, false},
    {"vertOffsetCorrection_", "vert_offset_correction", kMetresPerCentimetre, true},
    {"horizOffsetCorrection_", "horiz_offset_correction", kMetresPerCentimetre, false}};

/// The number that a text stands for. \throws FileError naming \p what if it is none
[[nodiscard]] double laserNumber(const std::filesystem::path& file, std::string_view text, const std::string& what);

/// \throws FileError as readVelodyneCalibration.
[[nodiscard]] LaserTable lasersOfXml(const std::filesystem::path& file, const std::string& content);
[[nodiscard]] LaserTable lasersOfYaml(const std::filesystem::path& file, const std::string& content);

}  // namespace pcl_floam
