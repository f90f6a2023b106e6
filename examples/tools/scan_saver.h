/// \file scan_saver.h
/// Scans without their distortion, as files.
#pragma once

#include <pcl_floam/odometry/core/odometry_parameters.h>
#include <pcl_floam/odometry/core/odometry_report.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace pcl_floam::tools {

/// Re-expresses every point at the instant that the poses describe, where the sensor's motion is known. Times that the
/// points had are then no longer theirs, and go; other fields stay.
/// \param frame_T_sensor where the sensor is in the cloud's frame
void undistort(pcl::PCLPointCloud2& cloud, const OdometryReport& report, const OdometryParameters& parameters,
               const SE3& frame_T_sensor = {});

/// The folder, created if need be, in which scans are written: those of two runs could not be told apart.
/// \throws FileError if it cannot be created or is not empty.
void prepareScanFolder(const std::filesystem::path& folder);

/// Writes undistorted scans as FOLDER/000000.pcd and so on, by the scan's number, and the times of their poses. While
/// poses are provisional the scans wait: which way the head turned, and how the sensor moved, may yet turn out to be
/// other than was supposed.
class ScanSaver {
public:
  /// \param folder as \ref prepareScanFolder wants it; empty: nothing is written
  /// \param frame_T_sensor where the sensor is in the scans' frame
  explicit ScanSaver(std::filesystem::path folder, const SE3& frame_T_sensor = {});

  /// \param time s, of the pose
  /// \throws FileError if the file cannot be written.
  void save(std::size_t scan, double time, pcl::PCLPointCloud2& cloud, const OdometryReport& report,
            const OdometryParameters& parameters);

  /// After the last scan. \throws FileError if a scan that waits or times.txt cannot be written.
  void finish();

private:
  struct Waiting {
    std::size_t scan;
    pcl::PCLPointCloud2 cloud;
    OdometryReport report;
    OdometryParameters parameters;
  };

  void correct(std::size_t scan, const OdometryReport& report);
  void writeWaiting();

  std::filesystem::path folder_;
  SE3 frame_T_sensor_;
  std::vector<double> times_;
  std::vector<Waiting> waiting_;
};

/// 000012.pcd
[[nodiscard]] std::string numberedName(std::size_t number);

}  // namespace pcl_floam::tools
