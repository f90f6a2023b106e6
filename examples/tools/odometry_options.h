/// \file odometry_options.h
/// The command line of pcl_floam_odometry.
#pragma once

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/core/odometry_parameters.h>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_floam::tools {

struct OdometryOptions {
  std::filesystem::path scans;
  std::string topic;  ///< of the scans in a recording; empty: there is but one
  std::filesystem::path output;
  std::filesystem::path ground_truth;  ///< empty: none
  std::filesystem::path calibration;   ///< of an HDL-64, or of the ground truth; empty: neither
  std::size_t from = 0;
  std::size_t max_scans = 0;  ///< 0: all
  std::string sensor = "auto";
  std::vector<float> elevations;    ///< degrees; of a sensor of the user's own
  std::vector<double> sensor_pose;  ///< x, y, z in m, roll, pitch, yaw in degrees; empty: scans are the sensor's
  std::optional<PoseInstant> pose_instant;  ///< nothing: what suits the format of the scans
  std::filesystem::path map;                ///< of an earlier run, to go on in; empty: none
  bool localize = false;                    ///< leave that map as it is
  std::vector<double> initial_pose;         ///< in that map: x, y, z in m, yaw in degrees; empty: its origin
  std::filesystem::path save_scans;         ///< folder for the undistorted scans; empty: none
  bool ply = false;                         ///< the path and the map as PLY, too
  std::vector<double> grid;                 ///< lowest and highest height in m of an occupancy grid; empty: none
  double grid_cell = 0.1;                   ///< m
  std::string plot = ".svg";                ///< ending of the picture; empty: none
  bool quiet = false;
  OdometryParameters parameters;
};

/// Declares all options, with the defaults that \p options holds.
void addOptions(CLI::App& app, OdometryOptions& options);

/// The odometry's settings that follow from the options and the format of the scans.
/// \throws std::invalid_argument for an unknown sensor or a setting out of its range.
[[nodiscard]] OdometryParameters parametersFor(const OdometryOptions& options, ScanFormat format);

}  // namespace pcl_floam::tools
