/// \file stage_inputs.h
/// The scans on which the odometry's stages are timed.
#pragma once

#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/odometry/odometry.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl_floam::benchmark {

using XYZI = pcl::PointXYZI;
using CloudXYZI = pcl::PointCloud<XYZI>;

/// Some consecutive scans of one sensor.
struct ScanSequence {
  std::string name;
  OdometryParameters parameters;
  std::vector<pcl::PCLPointCloud2> scans;
};

/// The drive KITTI raw 0001 in the folder \p data; without scans where it is not there.
[[nodiscard]] ScanSequence realDrive(const std::string& data);

/// Sweeps of a simulated world; without scans where the simulator was not built.
[[nodiscard]] ScanSequence simulatedSequence(const std::string& world, const std::string& sensor, std::size_t count);

/// What the stages of the odometry work on at the last scan of a sequence.
struct StageInput {
  explicit StageInput(const ScanSequence& sequence);

  OdometryParameters parameters;
  pcl::PCLPointCloud2 scan;
  CloudXYZI::Ptr cloud;  ///< the scan as PCL's classes take it
  ScanLines lines;
  ScanTiming timing;
  FeatureSet features;   ///< as measured
  KeyframeVoxelMap map;  ///< of all scans before
  SE3 world_T_scan;      ///< of the scan's middle
  Vector6 twist;         ///< of its sweep
};

}  // namespace pcl_floam::benchmark
