/// \file sweep_velocity.h
/// How the sensor moves during a sweep, from more than that sweep.
#pragma once

#include "odometry/axis_velocity.h"

#include <pcl_floam/filters/sweep_motion.h>

#include <array>

namespace pcl_floam {

/// The motion during a sweep from what all sweeps so far say of it: their own registrations and the motions between
/// their poses, axis by axis in the sensor's axes, where the motion of vehicles changes least.
///
/// The motion between two poses is known many times better than that during a sweep, but tells of the past: how far it
/// holds is learned while driving. It is what leads from the sweep's middle, where poses are registered, to its end.
class SweepVelocity {
public:
  /// \param twist per period, roughly known
  void begin(const Vector6& twist);

  /// \param registered     motion over the sweep, at its middle
  /// \param covariance     of the sweep's pose, in the sensor's axes
  /// \param sweep_fraction duration of the sweep in periods, > 0
  /// \param between        motion per period from the last tracked scan's pose to this one's
  /// \param periods        between those poses, > 0
  /// \return the same motion, better known; as it was after a gap
  SweepMotion refine(const SweepMotion& registered, const Matrix6& covariance, double sweep_fraction,
                     const Vector6& between, double periods);

private:
  std::array<AxisVelocity, 6> axes_;
};

}  // namespace pcl_floam
