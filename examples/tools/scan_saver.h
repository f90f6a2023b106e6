/// \file scan_saver.h
/// Scans without their distortion, as files.
#pragma once

#include <pcl_floam/odometry/odometry_parameters.h>
#include <pcl_floam/odometry/odometry_report.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <filesystem>

namespace pcl_floam::tools {

/// Re-expresses every point at the instant that the poses describe; fields other than x, y, z stay.
void undistort(pcl::PCLPointCloud2& cloud, const OdometryReport& report, const OdometryParameters& parameters);

/// Writes undistorted scans as FOLDER/000000.pcd and so on, by the scan's number.
class ScanSaver {
public:
  /// \param folder created if need be; empty: nothing is written
  /// \throws FileError if it cannot be created.
  explicit ScanSaver(std::filesystem::path folder);

  /// \throws FileError if the file cannot be written.
  void save(std::size_t scan, pcl::PCLPointCloud2& cloud, const OdometryReport& report,
            const OdometryParameters& parameters) const;

private:
  std::filesystem::path folder_;
};

/// 000012.pcd
[[nodiscard]] std::string numberedName(std::size_t number);

}  // namespace pcl_floam::tools
