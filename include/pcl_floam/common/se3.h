/// \file se3.h
/// Rigid motions and their Lie algebra: exp, log, interpolation, first-order Jacobians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pcl_floam {

/// A 6-vector without alignment requirements: its layout is the same for every compiler flag.
/// Order as in the paper's Eq. 11: translation part first, then rotation part.
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;

/// A 6x6 matrix without alignment requirements, rows and columns ordered as \ref Vector6.
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// A rigid motion `target_T_source`: maps points of frame `source` to frame `target`.
///
/// Two plain members (96 bytes, no alignment), so that it can cross the boundary between code compiled
/// with and without `-march` flags. Metres and a proper rotation matrix.
struct SE3 {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;

  /// The identity. Here and below number by number where it can be: an expression of Eigen's is longer for each
  /// compiler that reads this.
  SE3()
  {
    for (int i = 0; i < 9; ++i) {
      rotation.data()[i] = i % 4 == 0 ? 1.0 : 0.0;
    }
    for (int i = 0; i < 3; ++i) {
      translation.data()[i] = 0.0;
    }
  }
  SE3(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) : rotation(r), translation(t) {}

  template <typename Scalar, int Mode>
  explicit SE3(const Eigen::Transform<Scalar, 3, Mode>& transform)
      : rotation(transform.matrix().template topLeftCorner<3, 3>().template cast<double>()),
        translation(transform.matrix().template topRightCorner<3, 1>().template cast<double>())
  {
  }

  /// A homogeneous matrix: `Eigen::Matrix4f`, as PCL's registrations give it, or `Matrix4d`.
  template <typename Scalar, int Options>
  explicit SE3(const Eigen::Matrix<Scalar, 4, 4, Options>& matrix)
      : rotation(matrix.template topLeftCorner<3, 3>().template cast<double>()),
        translation(matrix.template topRightCorner<3, 1>().template cast<double>())
  {
  }

  [[nodiscard]] SE3 inverse() const;

  /// The 4x4 homogeneous matrix, last row exactly 0 0 0 1.
  template <typename Scalar = double>
  [[nodiscard]] Eigen::Matrix<Scalar, 4, 4> matrix() const
  {
    Eigen::Matrix<Scalar, 4, 4> m = Eigen::Matrix<Scalar, 4, 4>::Identity();
    m.template topLeftCorner<3, 3>() = rotation.cast<Scalar>();
    m.template topRightCorner<3, 1>() = translation.cast<Scalar>();
    return m;
  }

  template <typename Scalar = double>
  [[nodiscard]] Eigen::Transform<Scalar, 3, Eigen::Isometry> isometry() const
  {
    return Eigen::Transform<Scalar, 3, Eigen::Isometry>(matrix<Scalar>());
  }

  /// True when every number of it is finite.
  [[nodiscard]] bool isFinite() const;
};

[[nodiscard]] SE3 operator*(const SE3& a, const SE3& b);

[[nodiscard]] inline Eigen::Vector3d operator*(const SE3& a, const Eigen::Vector3d& p)
{
  const auto coordinate = [&](int i) {
    return a.rotation(i, 0) * p.x() + (a.rotation(i, 1) * p.y() + a.rotation(i, 2) * p.z()) + a.translation[i];
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

/// The rotation of angle |\p phi| rad about \p phi (Rodrigues).
[[nodiscard]] Eigen::Matrix3d expSO3(const Eigen::Vector3d& phi);

/// Inverse of \ref expSO3, angle in [0, pi].
[[nodiscard]] Eigen::Vector3d logSO3(const Eigen::Matrix3d& rotation);

/// The rigid motion of twist \p xi = (translation part in m, rotation part in rad), as used in Eq. 3.
[[nodiscard]] SE3 exp(const Vector6& xi);

/// Inverse of \ref exp, as used in Eq. 2 and Eq. 12a; rotation part in [0, pi].
[[nodiscard]] Vector6 log(const SE3& target_T_source);

/// The nearest proper rotation (in the Frobenius norm) to a matrix that rounding has bent.
[[nodiscard]] Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& m);

/// Rotation angle in rad, in [0, pi], accurate for small angles too.
[[nodiscard]] double rotationAngle(const Eigen::Matrix3d& rotation);

}  // namespace pcl_floam
