/// \file sweep_motion.h
/// The sensor's motion during one sweep, and the undoing of its distortion (Eq. 2 to 4, 12).
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/features.h>

#include <vector>

namespace pcl_floam {

/// Constant angular and linear velocity over one sweep.
///
/// With T(s) the sensor's pose at the fraction s of the sweep, T(s) = T(r) exp((s - r) xi): a point measured at s
/// is seen from the reference instant r at exp((s - r) xi) p. The paper's Eq. 3 has (N - n)/N in place of (s - r),
/// which moves the sweep's first point by the whole motion and the last by none; since xi is the motion *forward*
/// in time and the map is registered with the pose at one instant, only s - r is consistent with Eq. 5.
class SweepMotion {
public:
  /// \param twist     xi, motion from the sweep's start to its end, seen from the sensor: log(T(0)^-1 T(1))
  /// \param reference r in [0,1]: the instant at which points are expressed; 1 is the end of the sweep
  explicit SweepMotion(const Vector6& twist = Vector6::Zero(), double reference = 1.0)
      : twist_(twist), reference_(reference)
  {
  }

  [[nodiscard]] const Vector6& twist() const { return twist_; }
  [[nodiscard]] double reference() const { return reference_; }

  /// `sensor_at_reference_T_sensor_at_time` for a fraction of the sweep.
  [[nodiscard]] SE3 at(double time) const { return exp((time - reference_) * twist_); }

  /// True when nothing moves: compensation is a copy.
  [[nodiscard]] bool isStill() const { return twist_.isZero(0.0); }

private:
  Vector6 twist_;
  double reference_;
};

/// Re-expresses every feature at the motion's reference instant (Eq. 4, 12b).
/// \param[out] compensated overwritten; may not be \p features itself
void compensate(const std::vector<Feature>& features, const SweepMotion& motion, std::vector<Feature>& compensated);

/// \copydoc compensate
void compensate(const FeatureSet& features, const SweepMotion& motion, FeatureSet& compensated);

}  // namespace pcl_floam
