/// \file odometry_result.h
/// What an odometry run has left in its folder, or has so far.
#pragma once

#include <pcl_floam/io/trajectory.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <filesystem>

namespace pcl_floam::viewer {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

class OdometryResult {
public:
  /// \throws FileError if the folder has no poses, or a map that cannot be read.
  explicit OdometryResult(std::filesystem::path folder);

  [[nodiscard]] const Trajectory& poses() const { return poses_; }

  /// The map's layers; null while there is no map, which the odometry writes at its end.
  [[nodiscard]] const Cloud::ConstPtr& mapEdges() const { return map_edges_; }
  [[nodiscard]] const Cloud::ConstPtr& mapPlanes() const { return map_planes_; }

  /// Reads what a running odometry has written meanwhile. Files that are just being written wait for the next time.
  /// \return whether there is anything new
  bool refresh();

private:
  void readPoses();
  void readMap();

  std::filesystem::path folder_;
  Trajectory poses_;
  std::uintmax_t poses_size_ = 0;  ///< of the file, bytes
  std::filesystem::file_time_type map_time_;
  Cloud::ConstPtr map_edges_;
  Cloud::ConstPtr map_planes_;
};

}  // namespace pcl_floam::viewer
