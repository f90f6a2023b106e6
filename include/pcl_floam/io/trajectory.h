/// \file trajectory.h
/// Trajectories in KITTI's and TUM's text formats.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/io/file_error.h>

#include <filesystem>
#include <fstream>
#include <vector>

namespace pcl_floam {

/// A pose and its time.
struct StampedPose {
  double stamp = 0.0;  ///< s
  SE3 world_T_sensor;
};

using Trajectory = std::vector<StampedPose>;

enum class TrajectoryFormat {
  automatic,  ///< told by the number of columns
  kitti,      ///< 12 numbers a line: the upper three rows of the pose; stamps are the line numbers
  tum         ///< stamp tx ty tz qx qy qz qw
};

/// The format of a file, told by the number of columns of its first pose.
/// \throws FileError if the file cannot be read, has no pose, or has another number of columns.
[[nodiscard]] TrajectoryFormat trajectoryFormat(const std::filesystem::path& file);

/// Empty lines and lines that begin with # are skipped.
/// \throws FileError with file, line and reason.
[[nodiscard]] Trajectory readTrajectory(const std::filesystem::path& file,
                                        TrajectoryFormat format = TrajectoryFormat::automatic);

/// Writes poses one by one and flushes each, so that an interrupted run keeps all poses so far.
class TrajectoryWriter {
public:
  /// \throws FileError if the file cannot be created.
  TrajectoryWriter(std::filesystem::path file, TrajectoryFormat format);

  /// \throws FileError if it cannot be written (disk full).
  void write(const StampedPose& pose);

  /// Puts \p poses in place of all that was written; goes on after them. The file that was there stays until the new
  /// one is whole.
  ///
  /// \throws FileError if it cannot be replaced.
  void writeAgain(const Trajectory& poses);

private:
  std::filesystem::path path_;
  TrajectoryFormat format_;
  std::ofstream stream_;
};

}  // namespace pcl_floam
