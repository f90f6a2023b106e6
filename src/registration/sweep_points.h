/// \file sweep_points.h
/// Where the points of a moving sweep lie.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/scan_points.h>

#include <cstddef>

namespace pcl_floam {

/// The sensor's pose in the middle of a sweep, and its motion during it: T(u) = T exp(u xi + u^2 alpha / 2) for u in
/// [-1/2, 1/2] (Eq. 3 and 4; the paper's (N - n)/N moves the wrong end of the sweep, and of all its instants the middle
/// is the one whose pose depends least on the motion; without alpha, whatever sways is off by a part of each swing).
class MovingSensor {
public:
  explicit MovingSensor(const SE3& target_T_sensor, const Vector6& twist = Vector6::Zero(),
                        const Vector6& acceleration = Vector6::Zero())
      : pose_(target_T_sensor),
        velocity_(twist.head<3>()),
        turn_(twist.tail<3>()),
        half_acceleration_(0.5 * acceleration.head<3>()),
        half_turn_acceleration_(0.5 * acceleration.tail<3>())
  {
  }

  [[nodiscard]] const SE3& pose() const { return pose_; }

  /// Time from the sweep's middle, in sweeps.
  [[nodiscard]] static double sinceMiddle(const ScanPoint& point) { return static_cast<double>(point.time) - 0.5; }

  /// The place of a point in the sensor's frame of mid-sweep.
  [[nodiscard]] Eigen::Vector3d undistorted(const ScanPoint& point) const
  {
    Eigen::Vector3d place;
    undistorted(&point, 1, 1, &place);
    return place;
  }

  /// The same for \p count points, each \p stride after the one before.
  void undistorted(const ScanPoint* points, std::size_t stride, std::size_t count, Eigen::Vector3d* places) const;

  /// The place of a point in the target's frame.
  [[nodiscard]] Eigen::Vector3d at(const ScanPoint& point) const { return pose_ * undistorted(point); }

private:
  SE3 pose_;
  Eigen::Vector3d velocity_;
  Eigen::Vector3d turn_;
  Eigen::Vector3d half_acceleration_;
  Eigen::Vector3d half_turn_acceleration_;
};

}  // namespace pcl_floam
