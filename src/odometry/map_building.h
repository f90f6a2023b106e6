/// \file map_building.h
/// The paper's "Mapping Building & Distortion Compensation Update" (Eq. 12).
#pragma once

#include "motion/sweep_pose.h"
#include "odometry/scan_preparation.h"

#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/odometry/core/odometry_parameters.h>
#include <pcl_floam/odometry/odometry.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// The map that is given out: keyframes come in, undistorted, and what has gone leaves it.
class MapBuilding {
public:
  explicit MapBuilding(const OdometryParameters& parameters) : map_(parameters.map) {}

  [[nodiscard]] const KeyframeVoxelMap& map() const { return map_; }
  /// Whether there was a map before the first scan.
  [[nodiscard]] bool hasPrior() const { return prior_.has_value(); }

  void clear();

  /// Goes on with a map that was made before, near a pose.
  void begin(KeyframeVoxelMap map, MapUse use, const SE3& world_T_sensor);

  /// In place of the parameters' policy, if it is not empty.
  void chooseKeyframesBy(const KeyframeRule& rule) { rule_ = rule; }

  /// Takes in features as they were measured, if the sensor has moved far enough or there are none yet.
  /// \return whether it did
  bool add(const FeatureSet& measured, const SweepPose& world_T_sensor, const OdometryParameters& parameters);

  /// The same with all that a scan tells: what its returns see through has gone.
  bool add(const CloudView& cloud, PreparedScan& scan, const SweepPose& world_T_sensor,
           const OdometryParameters& parameters);

private:
  [[nodiscard]] bool takes(const SE3& world_T_sensor, const KeyframePolicy& policy) const;
  void undistort(const ScanReturns& measured, const SweepPose& world_T_sensor);
  void insert(const FeatureSet& measured, const SweepPose& world_T_sensor, int threads);

  KeyframeVoxelMap map_;
  FeatureSet undistorted_;                        // of the last keyframe
  std::vector<Eigen::Vector3f> all_undistorted_;  // of the last scan that was looked through
  std::optional<MapUse> prior_;
  KeyframeRule rule_;
  SE3 world_T_keyframe_;
  int keyframes_ = 0;
};

}  // namespace pcl_floam
