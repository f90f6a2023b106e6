#include <pcl_floam/motion/motion_hint.h>

#include "common/covariance.h"
#include "common/perturbation.h"

#include <Eigen/Cholesky>

#include <stdexcept>

namespace pcl_floam {

void MotionHint::validate() const
{
  const Eigen::Matrix<double, 6, 6> c = covariance;
  if (!last_T_now.isFinite() || !c.allFinite()) {
    throw std::invalid_argument("motion hint: it is not finite");
  }
  constexpr double kRounding = 1e-9;
  const bool is_symmetric = (c - c.transpose()).norm() <= kRounding * c.norm();
  if (!is_symmetric || Eigen::LLT<Eigen::Matrix<double, 6, 6>>(c).info() != Eigen::Success) {
    throw std::invalid_argument("motion hint: the covariance is not symmetric and positive definite");
  }
}

MotionHint MotionHint::inverse() const
{
  return {last_T_now.inverse(), propagated(adjoint(last_T_now), covariance)};
}

MotionHint operator*(const MotionHint& first, const MotionHint& second)
{
  const Matrix6 back = adjoint(second.last_T_now.inverse());
  return {first.last_T_now * second.last_T_now, propagated(back, first.covariance) + second.covariance};
}

}  // namespace pcl_floam
