/// \file result_writer.h
/// The results that are written scan by scan.
#pragma once

#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/odometry/odometry_report.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <vector>

namespace pcl_floam::tools {

/// Writes poses.kitti.txt, poses.tum.txt and timing.csv, flushed after every scan. Where poses are corrected later,
/// both files are written again.
class ResultWriter {
public:
  /// Creates the folder and the files.
  /// \throws FileError if that is not possible.
  explicit ResultWriter(const std::filesystem::path& folder);

  /// \param scan number of the scan in its folder
  /// \throws FileError if a file cannot be written (disk full).
  void write(std::size_t scan, double stamp, const OdometryReport& report);

  /// All poses so far, as they are known now.
  [[nodiscard]] const Trajectory& written() const { return written_; }

private:
  void writePoses(const StampedPose& pose, const std::vector<SE3>& corrected);

  TrajectoryWriter kitti_;
  TrajectoryWriter tum_;
  Trajectory written_;
  std::filesystem::path timing_path_;
  std::ofstream timing_;
};

/// One time in each line, s, as beside a folder of scans.
/// \throws FileError if it cannot be written.
void writeTimes(const std::vector<double>& times, const std::filesystem::path& file);

/// Writes a text file in one go.
/// \throws FileError if it cannot be written.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

}  // namespace pcl_floam::tools
