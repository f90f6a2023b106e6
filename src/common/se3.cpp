#include <pcl_floam/common/se3.h>

#include "common/perturbation.h"

#include <Eigen/SVD>

#include <cmath>

namespace pcl_floam {

namespace {

/// Below this angle (rad) the series of sin(x)/x and its kin are exact to double precision.
constexpr double kSmallAngle = 1e-4;

/// The matrix V of exp([rho, phi]) = (R, V rho): the left Jacobian of SO(3).
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi)
{
  const double angle2 = phi.squaredNorm();
  const Eigen::Matrix3d phi_x = skew(phi);
  double b = 0.5 - angle2 / 24.0;
  double c = 1.0 / 6.0 - angle2 / 120.0;
  if (angle2 > kSmallAngle * kSmallAngle) {
    const double angle = std::sqrt(angle2);
    const double half_sin = std::sin(0.5 * angle);
    b = 2.0 * half_sin * half_sin / angle2;
    c = (angle - std::sin(angle)) / (angle2 * angle);
  }
  return Eigen::Matrix3d::Identity() + b * phi_x + c * phi_x * phi_x;
}

}  // namespace

SE3 SE3::inverse() const
{
  return {rotation.transpose(), -(rotation.transpose() * translation)};
}

bool SE3::isFinite() const
{
  return rotation.allFinite() && translation.allFinite();
}

SE3 operator*(const SE3& a, const SE3& b)
{
  return {a.rotation * b.rotation, a * b.translation};
}

Eigen::Matrix3d expSO3(const Eigen::Vector3d& phi)
{
  const double angle2 = phi.squaredNorm();
  const Eigen::Matrix3d phi_x = skew(phi);
  double a = 1.0 - angle2 / 6.0;
  double b = 0.5 - angle2 / 24.0;
  if (angle2 > kSmallAngle * kSmallAngle) {
    const double angle = std::sqrt(angle2);
    const double half_sin = std::sin(0.5 * angle);
    a = std::sin(angle) / angle;
    b = 2.0 * half_sin * half_sin / angle2;
  }
  return Eigen::Matrix3d::Identity() + a * phi_x + b * phi_x * phi_x;
}

Eigen::Vector3d logSO3(const Eigen::Matrix3d& rotation)
{
  // By way of the quaternion: unlike the trace formula it loses no digits near 0 and near pi.
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();
  }
  const double sin_half = q.vec().norm();
  if (sin_half < 1e-12) {
    return 2.0 * q.vec();
  }
  return (2.0 * std::atan2(sin_half, q.w()) / sin_half) * q.vec();
}

SE3 exp(const Vector6& xi)
{
  const Eigen::Vector3d rho = xi.head<3>();
  const Eigen::Vector3d phi = xi.tail<3>();
  return {expSO3(phi), leftJacobian(phi) * rho};
}

Vector6 log(const SE3& target_T_source)
{
  const Eigen::Vector3d phi = logSO3(target_T_source.rotation);
  Vector6 xi;
  xi.head<3>() = leftJacobian(phi).inverse() * target_T_source.translation;
  xi.tail<3>() = phi;
  return xi;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& m)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) {
    sign.z() = -1.0;
  }
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

double rotationAngle(const Eigen::Matrix3d& rotation)
{
  return logSO3(rotation).norm();
}

}  // namespace pcl_floam
