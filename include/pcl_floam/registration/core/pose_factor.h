/// \file pose_factor.h
/// What else is known of a pose, beside points on surfaces: the interface for factors of one's own.
#pragma once

#include <pcl_floam/common/se3.h>

#include <Eigen/Core>

#include <memory>

namespace pcl_floam {

/// Sums of weighted residuals r that depend on a pose, and of their derivatives J by it: its step is -H^-1 b
/// (Eq. 11). The perturbation is (translation m, rotation rad), on the left, in the target's axes, the rotation about
/// the source's origin: a point at p (target) moves by t + w x (p - origin), a direction d by w x d.
struct PoseEquations {
  Matrix6 information = Matrix6::Zero();  ///< H = sum J^T J / variance
  Vector6 gradient = Vector6::Zero();     ///< b = sum J^T r / variance

  /// Adds one residual.
  /// \param residual   any unit
  /// \param derivative by the perturbation
  /// \param variance   of the residual, > 0, in its unit squared
  void add(double residual, const Vector6& derivative, double variance);
};

/// Something that is known of a pose: the ground that a robot stands on, a position from satellites, the brightness of
/// points. It counts beside the points by its variance, in every iteration.
///
/// What it gives must be finite, a function of the pose alone while a registration runs, and it may be asked by several
/// threads at a time. It must not throw.
class PoseFactor {
public:
  using Ptr = std::shared_ptr<PoseFactor>;
  using ConstPtr = std::shared_ptr<const PoseFactor>;

  virtual ~PoseFactor() = default;

  /// Adds its residuals, linearised at a pose; nothing if nothing is known just now.
  /// \param target_T_source the pose that is estimated; of an odometry `world_T_sensor` in the middle of the sweep
  virtual void addTo(const SE3& target_T_source, PoseEquations& equations) const = 0;
};

}  // namespace pcl_floam
