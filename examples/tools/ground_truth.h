/// \file ground_truth.h
/// The true poses of a folder's scans.
#pragma once

#include "pose_pairs.h"

#include <pcl_floam/io/scan_source.h>

#include <cstddef>
#include <filesystem>
#include <optional>

namespace pcl_floam::tools {

/// True poses by the number of the scan in its folder.
class GroundTruth {
public:
  /// By their times, if the file is TUM and most scans' times lie within it; else it must have as many poses as there
  /// are scans.
  /// \param calibration KITTI's calib.txt if the poses are the camera's, else empty
  /// \throws FileError if a file cannot be read or the poses cannot be assigned to the scans.
  GroundTruth(const std::filesystem::path& file, const std::filesystem::path& calibration, const ScanSource& scans);

  /// The pose of a scan; nothing if the file has none for it.
  /// \param time s, of the scan's pose
  [[nodiscard]] std::optional<SE3> pose(std::size_t scan, double time) const;

private:
  Trajectory trajectory_;
  bool is_by_time_ = false;
};

}  // namespace pcl_floam::tools
