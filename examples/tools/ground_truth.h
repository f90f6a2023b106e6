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
  /// A file with as many poses as the folder has scans gives one to each; else it must be TUM and the scans must have
  /// times, by which the poses are then found.
  /// \param calibration KITTI's calib.txt if the poses are the camera's, else empty
  /// \throws FileError if a file cannot be read or the poses cannot be assigned to the scans.
  GroundTruth(const std::filesystem::path& file, const std::filesystem::path& calibration, const ScanSource& scans);

  /// The pose of a scan; nothing if the file has none for its time.
  [[nodiscard]] std::optional<SE3> pose(std::size_t scan) const { return poses_.at(scan); }

private:
  std::vector<std::optional<SE3>> poses_;
};

}  // namespace pcl_floam::tools
