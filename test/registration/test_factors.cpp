// Residuals and their derivatives (Eq. 5, 7, 11, 13, 14).
#include "common/perturbation.h"
#include "registration/factors.h"
#include "registration/robust_kernel.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

/// d(exp(delta) q)/d(delta) at delta = 0: [I, -[q]x] (Eq. 11).
Eigen::Matrix<double, 3, 6> motionDerivative(const Eigen::Vector3d& q)
{
  Eigen::Matrix<double, 3, 6> derivative;
  derivative << Eigen::Matrix3d::Identity(), -skew(q);
  return derivative;
}

/// Derivative of a factor's residual by the left perturbation of the pose, by central differences.
Eigen::Matrix<double, 3, 6> numericJacobian(const Factor& factor, const Eigen::Vector3d& q)
{
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 3, 6> jacobian;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kStep * Vector6::Unit(i);
    jacobian.col(i) = (factor.residual(exp(step) * q) - factor.residual(exp(Vector6(-step)) * q)) / (2.0 * kStep);
  }
  return jacobian;
}

void expectJacobian(const Factor& factor, const Eigen::Vector3d& q)
{
  const Eigen::Matrix<double, 3, 6> analytic = factor.derivative() * motionDerivative(q);
  EXPECT_LT((analytic - numericJacobian(factor, q)).norm(), 1e-7);
}

TEST(Factors, JacobiansAgreeWithNumericOnes)
{
  std::mt19937 random(1);
  for (int n = 0; n < 50; ++n) {
    const Eigen::Vector3d center = randomVector(random, 20.0);
    const Eigen::Vector3d direction = randomVector(random, 1.0).normalized();
    const Eigen::Vector3d point = center + randomVector(random, 1.0);
    expectJacobian(Factor{FeatureKind::edge, center, direction}, point);
    expectJacobian(Factor{FeatureKind::plane, center, direction}, point);
  }
}

TEST(Factors, JacobiansExistAtDistanceZero)
{
  const Eigen::Vector3d center(3.0, 4.0, 5.0);
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 1.0, 2.0).normalized();
  const Factor edge{FeatureKind::edge, center, direction};
  EXPECT_LT(edge.residual(center + 2.0 * direction).norm(), 1e-15);
  expectJacobian(edge, center);
  expectJacobian(Factor{FeatureKind::plane, center, direction}, center);
}

TEST(Factors, EdgeResidualIsTheDistanceOfEquation5)
{
  std::mt19937 random(2);
  for (int n = 0; n < 50; ++n) {
    const Factor edge{FeatureKind::edge, randomVector(random, 9.0), randomVector(random, 1.0).normalized()};
    const Eigen::Vector3d point = randomVector(random, 9.0);
    const double of_equation5 = (point - edge.center).cross(edge.direction).norm();
    EXPECT_NEAR(edge.residual(point).norm(), of_equation5, 1e-12);
    EXPECT_NEAR(edge.residual(point).dot(edge.direction), 0.0, 1e-12);
    EXPECT_LT((edge.residual(point + 7.0 * edge.direction) - edge.residual(point)).norm(), 1e-12);
  }
}

TEST(Factors, EdgeGradientIsThatOfEquation13)
{
  // Eq. 13's scalar residual f = |(Tp - p) x n| has the gradient r^T J / f.
  const Factor edge{FeatureKind::edge, Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(0.0, 0.6, 0.8)};
  const Eigen::Vector3d q(2.0, 1.0, 4.0);
  const Eigen::Vector3d cross = (q - edge.center).cross(edge.direction);
  const Eigen::Vector3d p_n = cross.normalized();
  Eigen::Matrix<double, 1, 6> of_equation13;
  const Eigen::Matrix<double, 3, 6> motion = motionDerivative(q);
  for (int i = 0; i < 6; ++i) {
    of_equation13[i] = p_n.dot(Eigen::Vector3d(motion.col(i)).cross(edge.direction));
  }
  const Eigen::Matrix<double, 1, 6> ours =
      edge.residual(q).transpose() * edge.derivative() * motion / edge.residual(q).norm();
  EXPECT_LT((ours - of_equation13).norm(), 1e-12);
}

TEST(Factors, PlaneResidualIsTheVectorAcrossIt)
{
  const Factor plane{FeatureKind::plane, Eigen::Vector3d(0.0, 0.0, 2.0), Eigen::Vector3d::UnitZ()};
  EXPECT_DOUBLE_EQ(plane.residual(Eigen::Vector3d(5.0, -3.0, 2.5)).z(), 0.5);
  EXPECT_DOUBLE_EQ(plane.residual(Eigen::Vector3d(-5.0, 9.0, 1.5)).z(), -0.5);
}

TEST(RobustKernel, WeightIsTheDerivativeOfTheCost)
{
  for (const RobustKernel kernel :
       {RobustKernel::none, RobustKernel::huber, RobustKernel::cauchy, RobustKernel::geman_mcclure}) {
    for (const double squared : {1e-6, 0.01, 0.2, 1.0, 30.0}) {
      const double step = 1e-5 * squared;
      const double numeric =
          (robustCost(kernel, squared + step, 0.3) - robustCost(kernel, squared - step, 0.3)) / (2.0 * step);
      EXPECT_NEAR(robustWeight(kernel, squared, 0.3), numeric, 1e-6) << toString(kernel) << ' ' << squared;
    }
  }
}

TEST(RobustKernel, LeavesSmallResidualsAndCurbsLargeOnes)
{
  for (const RobustKernel kernel : {RobustKernel::huber, RobustKernel::cauchy, RobustKernel::geman_mcclure}) {
    EXPECT_NEAR(robustWeight(kernel, 1e-8, 0.1), 1.0, 1e-5);
    EXPECT_LT(robustWeight(kernel, 100.0, 0.1), 0.011);
  }
}

}  // namespace
}  // namespace pcl_floam::test
