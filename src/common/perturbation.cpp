#include "common/perturbation.h"

namespace pcl_floam {

Eigen::Matrix3d skew(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Matrix6 adjoint(const SE3& t)
{
  Matrix6 a = turnOf(t.rotation);
  a.topRightCorner<3, 3>() = skew(t.translation) * t.rotation;
  return a;
}

Matrix6 leverOf(const Eigen::Vector3d& arm)
{
  Matrix6 lever = Matrix6::Identity();
  lever.topRightCorner<3, 3>() = skew(arm);
  return lever;
}

Matrix6 turnOf(const Eigen::Matrix3d& rotation)
{
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = rotation;
  turn.bottomRightCorner<3, 3>() = rotation;
  return turn;
}

}  // namespace pcl_floam
