/// \file motion_model.h
/// How a world point depends on the unknowns: one pose, perturbed on the left (Eq. 11).
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// The paper's motion model: all points move with one rigid pose.
///
/// With LOAM's iterative compensation a point measured at the fraction s of the sweep follows only a part of a change
/// of the pose at the sweep's end: all of it at the end, next to none at the start, which the last pose holds. That
/// part is the point's *response*; without it the steps fall short and the iterations take three times as many.
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
