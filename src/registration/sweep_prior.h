/// \file sweep_prior.h
/// What is expected of a sweep before it is registered.
#pragma once

#include "common/covariance.h"

namespace pcl_floam {

/// What is expected of a sweep.
struct SweepPrior {
  SE3 pose;                                   ///< target_T_sensor at mid-sweep: the guess
  Vector6 velocity = Vector6::Zero();         ///< there, m and rad a period, in the sensor's axes
  Vector6 velocity_before = Vector6::Zero();  ///< in the middle of the sweep before
  double periods_between = 0.0;               ///< since then; 0: the velocity is taken for constant
  /// Of pose and velocity: perturbations on the left (translation m, rotation rad), about the sensor's position, the
  /// target's axes.
  Matrix12 covariance = Matrix12::Identity();
  bool pose_counts = true;           ///< as a measurement of that covariance; else it is where to begin
  double fraction = 0.0;             ///< duration of the sweep in periods
  Matrix6 hinted = Matrix6::Zero();  ///< information: what others than the scans have told of the motion to the pose

  /// H of pose and velocity: by how much the velocity follows the pose, and how well it is known then; and, if it
  /// counts, how well the pose is known.
  [[nodiscard]] Matrix12 information() const;

  /// The same with nothing in common between what is known of some motions and of all others.
  /// \param onto projects on these motions
  [[nodiscard]] SweepPrior apartFrom(const Matrix6& onto) const;

  /// A pose and the velocity that goes with it.
  struct State {
    SE3 pose;
    Vector6 velocity;
  };
  /// What is expected if the pose is off by a perturbation: the velocity follows it.
  [[nodiscard]] State movedBy(const Vector6& off) const;

  /// How far a pose and a velocity are from what was expected.
  [[nodiscard]] Vector12 offset(const SE3& target_T_sensor, const Vector6& at_velocity) const;
};

/// What nothing is known of, as information: a kilometre, 1/m^2 and 1/rad^2.
inline constexpr double kNothingKnown = 1e-6;

}  // namespace pcl_floam
