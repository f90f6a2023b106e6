/// \file perturbation.h
/// How small motions (translation, rotation) look from elsewhere.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// The cross-product matrix: `skew(a) * b == a.cross(b)`.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// How a perturbation in the source's axes looks in the target's: t exp(xi) = exp(adjoint(t) xi) t.
[[nodiscard]] Matrix6 adjoint(const SE3& t);

/// A perturbation (t, w) about a point is (t + arm x w, w) about one that lies \p arm nearer.
[[nodiscard]] Matrix6 leverOf(const Eigen::Vector3d& arm);

/// Turns perturbations about a point into other axes.
[[nodiscard]] Matrix6 turnOf(const Eigen::Matrix3d& rotation);

}  // namespace pcl_floam
