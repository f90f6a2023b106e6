/// \file sweep_velocity.h
/// How the sensor moves during a sweep, from more than that sweep.
#pragma once

#include "odometry/axis_velocity.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/sweep_motion.h>

#include <array>

namespace pcl_floam {

/// The motion during a sweep from what all sweeps so far say of it: their own registrations and the motions between
/// their poses, axis by axis in the sensor's axes, where the motion of vehicles changes least.
///
/// The motion between two poses is known many times better than that during a sweep, but tells of the past: how far it
/// holds is learned on the way. Poses are registered at the middle of the sweep; what is refined here leads to its end.
class SweepVelocity {
public:
  /// \param twist per period, roughly known. Without this the first sweep is taken for it.
  void begin(const Vector6& twist);

  /// \param registered     motion over the sweep, at its middle. Its acceleration is not used.
  /// \param covariance     of the sweep's pose, in the sensor's axes; its diagonal is used
  /// \param sweep_fraction duration of the sweep in periods, > 0
  /// \param between        motion per period from the last tracked scan's pose to this one's
  /// \param periods        between those poses, > 0
  /// \return the same motion, better known; as it was for the first sweep and after gaps of more than three periods
  SweepMotion refine(const SweepMotion& registered, const Matrix6& covariance, double sweep_fraction,
                     const Vector6& between, double periods);

private:
  std::array<AxisVelocity, 6> axes_;
  bool begun_ = false;
};

}  // namespace pcl_floam
