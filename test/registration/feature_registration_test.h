/// \file feature_registration_test.h
/// Features of a furnished room, registered with its map.
#pragma once

#include "support/synthetic_cloud.h"

#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/core/feature_registration.h>

#include <gtest/gtest.h>

#include <vector>

namespace pcl_floam::test {

/// A map of the room from some places, and a scan taken from another place, relative to \p origin.
class FeatureRegistrationTest : public testing::Test {
protected:
  static double distance(const SE3& a, const SE3& b) { return (a.translation - b.translation).norm(); }
  static double angle(const SE3& a, const SE3& b) { return rotationAngle(a.rotation.transpose() * b.rotation); }

  void mapRoom(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(), SearchMethod search = SearchMethod::voxel)
  {
    MapParameters parameters;
    parameters.search = search;
    map_ = KeyframeVoxelMap(parameters);
    for (const double x : {-1.0, 0.0, 1.0}) {
      const SE3 pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0.3 * x, 0.2 * x));
      map_.insert(featuresOf(toCloud(sweepRoom(room_, lidar_, pose))), SE3(pose.rotation, pose.translation + origin));
    }
  }

  RegistrationReport run(const SE3& guess, int threads = 1)
  {
    RegistrationRun run;
    run.guess = guess;
    run.threads = threads;
    run.factors = factors_;
    run.translation_epsilon *= precision_;
    run.rotation_epsilon *= precision_;
    run.max_iterations = iterations_;
    return registerFeatures(scan_, {&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)}, run,
                            parameters_);
  }

  Room room_;
  Lidar lidar_;
  SE3 truth_ = exp((Vector6() << 0.4, -0.3, 0.1, 0.02, -0.03, 0.15).finished());
  SE3 guess_ = truth_ * exp((Vector6() << 0.2, -0.1, 0.1, 0.01, 0.02, -0.03).finished());
  FeatureSet scan_ = featuresOf(toCloud(sweepRoom(room_, lidar_, truth_)));
  KeyframeVoxelMap map_;
  RegistrationParameters parameters_;
  std::vector<PoseFactor::ConstPtr> factors_;
  int iterations_ = 30;
  double precision_ = 1.0;  ///< of the convergence, in usual ones
};

}  // namespace pcl_floam::test
