/// \file sweep_motion.h
/// The sensor's motion during one sweep, and the undoing of its distortion (Eq. 2 to 4, 12).
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/core/features.h>

#include <vector>

namespace pcl_floam {

/// Constant angular and linear velocity over one sweep, or constant accelerations.
///
/// With T(s) the sensor's pose at the fraction s of the sweep, T(s) = T(r) exp((s - r) xi): a point measured at s
/// is seen from the reference instant r at exp((s - r) xi) p. The paper's Eq. 3 has (N - n)/N in place of (s - r),
/// which moves the sweep's first point by the whole motion and the last by none; since xi is the motion *forward*
/// in time and the map is registered with the pose at one instant, only s - r is consistent with Eq. 5.
///
/// An acceleration alpha, which the paper leaves out, adds (s - r)^2 alpha / 2 to the exponent.
class SweepMotion {
public:
  /// \param twist        xi, motion from the sweep's start to its end, seen from the sensor: log(T(0)^-1 T(1)); with an
  ///                     acceleration the velocity at the reference instant, over one sweep
  /// \param reference    r in [0,1]: the instant at which points are expressed; 1 is the end of the sweep
  /// \param acceleration alpha, change of the velocity over the sweep
  explicit SweepMotion(const Vector6& twist = Vector6::Zero(), double reference = 1.0,
                       const Vector6& acceleration = Vector6::Zero())
      : twist_(twist), acceleration_(acceleration), reference_(reference)
  {
  }

  [[nodiscard]] const Vector6& twist() const { return twist_; }
  [[nodiscard]] const Vector6& acceleration() const { return acceleration_; }
  [[nodiscard]] double reference() const { return reference_; }

  /// `sensor_at_reference_T_sensor_at_time` for a fraction of the sweep.
  [[nodiscard]] SE3 at(double time) const
  {
    const double since = time - reference_;
    return exp(since * twist_ + 0.5 * since * since * acceleration_);
  }

  /// True when nothing moves: compensation is a copy.
  [[nodiscard]] bool isStill() const { return twist_.isZero(0.0) && acceleration_.isZero(0.0); }

private:
  Vector6 twist_;
  Vector6 acceleration_;
  double reference_;
};

/// Re-expresses every feature at the motion's reference instant (Eq. 4, 12b).
/// \param[out] compensated overwritten; may not be \p features itself
/// \param threads         1 or more; the result does not depend on it
void compensate(const std::vector<Feature>& features, const SweepMotion& motion, std::vector<Feature>& compensated,
                int threads = 1);

/// \copydoc compensate
void compensate(const FeatureSet& features, const SweepMotion& motion, FeatureSet& compensated, int threads = 1);

}  // namespace pcl_floam
