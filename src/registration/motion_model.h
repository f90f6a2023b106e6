/// \file motion_model.h
/// How a world point depends on the unknowns: one pose, perturbed on the left (Eq. 11).
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// The paper's motion model: all points move with one rigid pose.
///
/// With LOAM's iterative compensation a change of the pose changes the sweep's motion, too, since the last pose stays
/// where it was: a point measured before the pose's instant follows less of the change, one measured after it more. How
/// much is the point's *response*, 1 at the instant itself; without it the derivative of the world point is wrong.
struct RigidMotion {
  static constexpr int kUnknowns = 6;

  /// d(exp(delta) q)/d(delta) at delta = 0 for the transformed point q = T p: [I, -[q]x] (Eq. 11), times the response.
  [[nodiscard]] static Eigen::Matrix<double, 3, 6> derivative(const Eigen::Vector3d& q, double response = 1.0)
  {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian.leftCols<3>().setIdentity();
    jacobian.rightCols<3>() << 0.0, q.z(), -q.y(), -q.z(), 0.0, q.x(), q.y(), -q.x(), 0.0;
    return response * jacobian;
  }
};

}  // namespace pcl_floam
