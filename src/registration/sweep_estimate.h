/// \file sweep_estimate.h
/// Pose and velocity of a sweep, as the iterations have them.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/surface_registration.h"
#include "registration/sweep_prior.h"

namespace pcl_floam {

struct SweepEstimate {
  SE3 pose;          ///< target_T_sensor at mid-sweep
  Vector6 velocity;  ///< per period, in the sensor's axes

  /// By a perturbation on the left of the pose about the sensor, in the target's axes.
  void move(const Vector6& perturbation)
  {
    pose.translation += perturbation.head<3>();
    pose.rotation = nearestRotation(expSO3(perturbation.tail<3>()) * pose.rotation);
  }

  /// And of the velocity, after it.
  void take(const Vector12& step)
  {
    const Eigen::Matrix3d back = pose.rotation.transpose();
    velocity.head<3>() += back * step.segment<3>(6);
    velocity.tail<3>() += back * step.segment<3>(9);
    move(step.head<6>());
  }
};

/// By what the points of a sweep are placed.
class SweepPlacing {
public:
  SweepPlacing(const SweepPrior& prior, SweepPlacement placement) : prior_(prior), placement_(placement) {}

  [[nodiscard]] Vector6 twist(const SweepEstimate& at) const { return prior_.fraction * velocityOf(at); }

  /// Over the sweep, from how the velocity has changed since the last one.
  [[nodiscard]] Vector6 acceleration(const SweepEstimate& at) const
  {
    return prior_.periods_between > 0.0 ? Vector6(prior_.fraction * prior_.fraction / prior_.periods_between *
                                                  (velocityOf(at) - prior_.velocity_before))
                                        : Vector6(Vector6::Zero());
  }

  [[nodiscard]] SweepTrajectory trajectory(const SweepEstimate& at) const
  {
    return SweepTrajectory(at.pose, twist(at), SweepTrajectory::kMiddle, acceleration(at));
  }

private:
  [[nodiscard]] const Vector6& velocityOf(const SweepEstimate& at) const
  {
    return placement_ == SweepPlacement::held ? prior_.velocity : at.velocity;
  }

  const SweepPrior& prior_;
  SweepPlacement placement_;
};

}  // namespace pcl_floam
