#include "odometry_result.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

#include <system_error>
#include <utility>

namespace pcl_floam::viewer {

namespace {

constexpr const char* kPosesFile = "poses.kitti.txt";

}  // namespace

OdometryResult::OdometryResult(std::filesystem::path folder) : folder_(std::move(folder))
{
  readPoses();
  readMap();
}

void OdometryResult::readPoses()
{
  const std::filesystem::path file = folder_ / kPosesFile;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  poses_ = readTrajectory(file, TrajectoryFormat::kitti);
  poses_size_ = error ? 0 : size;
}

void OdometryResult::readMap()
{
  std::error_code error;
  const auto time = std::filesystem::last_write_time(folder_ / kMapPlanesFile, error);
  if (error || time == map_time_) {
    return;
  }
  const KeyframeVoxelMap map = loadMap(folder_);
  map_edges_ = map.cloud(FeatureKind::edge);
  map_planes_ = map.cloud(FeatureKind::plane);
  map_time_ = time;
}

bool OdometryResult::refresh()
{
  const std::size_t poses = poses_.size();
  const Cloud::ConstPtr planes = map_planes_;
  try {
    std::error_code error;
    if (std::filesystem::file_size(folder_ / kPosesFile, error) != poses_size_ && !error) {
      readPoses();
    }
    readMap();
  } catch (const FileError&) {  // half written: what there was stays
  }
  return poses_.size() != poses || map_planes_ != planes;
}

}  // namespace pcl_floam::viewer
