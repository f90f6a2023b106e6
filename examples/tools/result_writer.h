/// \file result_writer.h
/// The results that are written scan by scan.
#pragma once

#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/odometry/core/odometry_report.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pcl_floam::tools {

/// A table whose rows are in the file as soon as they end.
class CsvFile {
public:
  /// \param columns their names, with commas between them
  /// \throws FileError if it cannot be made.
  CsvFile(const std::filesystem::path& path, const std::string& columns);

  [[nodiscard]] std::ostream& row() { return stream_; }
  /// \throws FileError if the row cannot be written.
  void endRow();

private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

/// Writes poses.kitti.txt, poses.tum.txt, timing.csv and scans.csv, flushed after every scan. Where poses are corrected
/// later, both files of poses are written again; scans.csv keeps what was said of a scan when it came.
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
  void writeStageTimes(std::size_t scan, const StageTimes& times);
  void writeVerdict(std::size_t scan, const OdometryReport& report);

  TrajectoryWriter kitti_;
  TrajectoryWriter tum_;
  Trajectory written_;
  CsvFile timing_;
  CsvFile scans_;
};

/// One time in each line, s, as beside a folder of scans.
/// \throws FileError if it cannot be written.
void writeTimes(const std::vector<double>& times, const std::filesystem::path& file);

/// Writes a text file in one go.
/// \throws FileError if it cannot be written.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

}  // namespace pcl_floam::tools
