/// \file sharpness.h
/// What tells of a trajectory's accuracy without ground truth, as text and as JSON: the sharpness of the map, and rest.
#pragma once

#include <pcl_floam/evaluation/map_sharpness.h>
#include <pcl_floam/evaluation/trajectory_metrics.h>
#include <pcl_floam/io/trajectory.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <string>

namespace pcl_floam::tools {

using Json = nlohmann::ordered_json;

/// A trajectory, and where it is from.
struct TrajectoryFile {
  std::filesystem::path path;
  Trajectory poses;
  bool has_times = false;  ///< its stamps are times, not numbers of lines
};

struct Sharpness {
  MapSharpness map;
  std::size_t scans = 0;  ///< that have a pose
  double radius = 0.0;    ///< m, of the neighbourhoods
};

/// Reads the scans of a folder or recording, which must be undistorted. The n-th one has the n-th pose; where there are
/// more or fewer and both have times, the pose at its time, interpolated, and those without one are left out.
/// \throws FileError if a scan cannot be read, or if they do not belong to the poses.
[[nodiscard]] Sharpness measureSharpness(const std::filesystem::path& scans, const TrajectoryFile& trajectory,
                                         const MapSharpnessParameters& parameters);

/// The figures are null if no neighbourhood was judged.
[[nodiscard]] Json toJson(const Sharpness& sharpness);
[[nodiscard]] Json toJson(const RestMetric& rest);

/// Lines for a reader, without a final line end.
[[nodiscard]] std::string describe(const Sharpness& sharpness);
[[nodiscard]] std::string describe(const RestMetric& rest);

}  // namespace pcl_floam::tools
