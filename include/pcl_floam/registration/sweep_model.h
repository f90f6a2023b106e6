/// \file sweep_model.h
/// How the registration lets the sensor move during the sweep that it registers.
#pragma once

#include <pcl_floam/common/se3.h>

#include <cstdint>

namespace pcl_floam {

/// What of the motion during the sweep is estimated together with the pose.
enum class SweepFreedom : std::uint8_t {
  fixed,         ///< nothing: the sweep is undistorted with the given twist and moves as one (the paper)
  follows_pose,  ///< the twist follows from the pose, since an earlier pose is held (LOAM)
  free           ///< the twist is estimated, too: 12 unknowns, held together by a motion prior
};

/// What is known of pose and twist before a scan is registered: a constant velocity, disturbed by white noise.
///
/// Translation and rotation are disturbed independently and alike in all directions. Pose and twist are correlated:
/// a velocity that has changed has moved the pose, too.
struct MotionPrior {
  SE3 pose;                         ///< expected target_T_sensor at the sweep's reference instant
  Vector6 twist = Vector6::Zero();  ///< expected motion over the sweep

  /// Variances and covariance of one coordinate.
  struct Spread {
    double pose = 1.0;    ///< m^2 or rad^2; > 0
    double twist = 1.0;   ///< m^2 or rad^2; > 0
    double common = 0.0;  ///< covariance of the two; its square must be less than their product
  };
  Spread translation;
  Spread rotation;
};

/// The sensor's motion during the sweep. The default is a sensor that stands still.
struct SweepModel {
  SweepFreedom freedom = SweepFreedom::fixed;
  /// Motion from the sweep's start to its end, seen from the sensor: log(T(0)^-1 T(1)). A first guess unless it is
  /// fixed; with `follows_pose` it is not used.
  Vector6 twist = Vector6::Zero();
  double reference = 1.0;  ///< the instant of the pose, as a fraction of the sweep; [0, 1]

  /// With `follows_pose`: twist = sweep_per_motion * log(held_pose^-1 * pose).
  SE3 held_pose;
  double sweep_per_motion = 0.0;

  /// With `free`.
  MotionPrior prior;
  Vector6 last_twist = Vector6::Zero();  ///< of the sweep before, as motion over one as long as this
  double sweeps_since_last = 0.0;        ///< time from that sweep to this one, in sweeps; 0: nothing is known of it

  /// Change of the velocity over the sweep that goes with a twist: as it has changed since the sweep before.
  ///
  /// The sensor sees ahead at one time of its sweep and aside at another, so that a change of pitch that is left out
  /// looks like a rate of roll. With it the rate in the simulated city falls from 0.041 to 0.031 %, the error of
  /// handheld sensors from 0.67 and 0.46 to 0.44 and 0.35 cm. Half as much again is worse on roads, where bodies sway
  /// quicker.
  [[nodiscard]] Vector6 acceleration(const Vector6& twist_now) const
  {
    if (freedom != SweepFreedom::free || !(sweeps_since_last > 0.0)) {
      return Vector6::Zero();
    }
    return (twist_now - last_twist) / sweeps_since_last;
  }
};

}  // namespace pcl_floam
