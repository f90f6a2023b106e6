/// \file motion_spline.h
/// A motion through space that is smooth in time.
#pragma once

#include <pcl_floam/common/se3.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam::simulator {

/// Where a body is: x, y, z in m, then yaw, pitch, roll in rad; rotation = Rz(yaw) Ry(pitch) Rx(roll).
/// Continuous: angles are not wrapped.
using BodyState = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;

/// The pose `world_T_body` of a state.
[[nodiscard]] SE3 poseOf(const BodyState& state);

/// A motion as a uniform cubic B-spline over body states.
///
/// Its acceleration is continuous, and nowhere greater than the greatest second difference of its controls over
/// the squared interval: what bounds the controls bounds the motion.
class MotionSpline {
public:
  /// A body that stays where it is.
  explicit MotionSpline(const BodyState& state);

  /// \param interval s from one control to the next
  /// \param controls at least four; the spline passes near them, from about the second to about the last but one
  MotionSpline(double interval, std::vector<BodyState> controls);

  /// s; the motion is defined from 0 to here, and its ends are kept before and after.
  [[nodiscard]] double duration() const;

  [[nodiscard]] BodyState state(double t) const;
  [[nodiscard]] SE3 pose(double t) const { return poseOf(state(t)); }

  /// First derivative of the position, m/s.
  [[nodiscard]] Eigen::Vector3d velocity(double t) const;

  /// Second derivative of the position, m/s^2.
  [[nodiscard]] Eigen::Vector3d acceleration(double t) const;

  /// Upper bound of |acceleration| over the whole motion, m/s^2.
  [[nodiscard]] double accelerationBound() const;

private:
  [[nodiscard]] BodyState blend(double t, double (*weight)(int, double)) const;

  double interval_;
  std::vector<BodyState> controls_;
};

}  // namespace pcl_floam::simulator
