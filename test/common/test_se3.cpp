// Laws of rigid motions.
#include "common/perturbation.h"
#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/common/se3.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pcl_floam::test {
namespace {

double difference(const SE3& a, const SE3& b)
{
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

SE3 randomPose(std::mt19937& random)
{
  return exp(randomTwist(random, 10.0, 1.7));
}

TEST(Se3, LogUndoesExpAtEveryAngle)
{
  std::mt19937 random(1);
  for (const double angle :
       {0.0, 1e-15, 1e-9, 1e-6, 0.9e-4, 1.1e-4, 1e-3, 0.1, 1.0, 2.0, 3.0, kPi - 1e-3, kPi - 1e-6}) {
    for (int n = 0; n < 20; ++n) {
      Vector6 twist = randomTwist(random, 5.0, 1.0);
      twist.tail<3>() *= angle / twist.tail<3>().norm();
      EXPECT_LT((log(exp(twist)) - twist).norm(), 1e-8) << "angle " << angle;
    }
  }
}

TEST(Se3, ExpUndoesLogAtHalfATurn)
{
  // At pi the axis may come back reversed, but it must be the same motion.
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1),
                                      Eigen::Vector3d(-1, 2, 3), Eigen::Vector3d(-1, -1, 1e-9)}) {
    for (const double angle : {kPi, kPi - 1e-12, kPi + 1e-12}) {
      const SE3 pose(expSO3(angle * axis.normalized()), Eigen::Vector3d(1.0, -2.0, 3.0));
      const Vector6 twist = log(pose);
      EXPECT_LE(twist.tail<3>().norm(), kPi + 1e-12);
      EXPECT_LT(difference(exp(twist), pose), 1e-9);
    }
  }
}

TEST(Se3, ExpOfOppositeTwistsAreInverse)
{
  std::mt19937 random(2);
  for (int n = 0; n < 50; ++n) {
    const Vector6 twist = randomTwist(random, 10.0, 2.0);
    EXPECT_LT(difference(exp(twist) * exp(Vector6(-twist)), SE3()), 1e-12);
  }
}

TEST(Se3, ExpIsAOneParameterGroup)
{
  std::mt19937 random(3);
  for (const double limit : {1.0, 0.9e-4, 0.3e-4}) {  // at the small angles, too, for which series are summed
    for (int n = 0; n < 50; ++n) {
      const Vector6 twist = randomTwist(random, 10.0, limit);
      EXPECT_LT(difference(exp(Vector6(0.3 * twist)) * exp(Vector6(0.7 * twist)), exp(twist)), 1e-12);
    }
  }
}

TEST(Se3, ExpFollowsItsDifferentialEquation)
{
  // dT/ds = T [xi]x, integrated in small steps: independent of Rodrigues' formula.
  Vector6 twist;
  twist << 1.0, -2.0, 0.5, 0.4, -0.8, 1.1;
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.topLeftCorner<3, 3>() << 0.0, -1.1, -0.8, 1.1, 0.0, -0.4, 0.8, 0.4, 0.0;
  generator.topRightCorner<3, 1>() << 1.0, -2.0, 0.5;
  constexpr int kSteps = 1 << 12;
  const Eigen::Matrix4d small = generator / kSteps;
  Eigen::Matrix4d product = Eigen::Matrix4d::Identity() + small + 0.5 * small * small;
  for (int doubling = 0; doubling < 12; ++doubling) {
    product = (product * product).eval();
  }
  EXPECT_LT((exp(twist).matrix() - product).norm(), 1e-6);
}

TEST(Se3, GroupAxioms)
{
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    const SE3 a = randomPose(random);
    const SE3 b = randomPose(random);
    const SE3 c = randomPose(random);
    EXPECT_LT(difference((a * b) * c, a * (b * c)), 1e-11);
    EXPECT_LT(difference(a * SE3(), a), 1e-15);
    EXPECT_LT(difference(SE3() * a, a), 1e-15);
    EXPECT_LT(difference(a * a.inverse(), SE3()), 1e-11);
    EXPECT_LT(difference(a.inverse() * a, SE3()), 1e-11);
    EXPECT_LT(((a.rotation.transpose() * a.rotation) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(a.rotation.determinant(), 1.0, 1e-12);
  }
}

TEST(Se3, ProductActsAsOneMotionAfterTheOther)
{
  std::mt19937 random(5);
  const SE3 a = randomPose(random);
  const SE3 b = randomPose(random);
  const Eigen::Vector3d p(1.0, 2.0, -3.0);
  EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
  const Eigen::Vector4d homogeneous = a.matrix() * p.homogeneous();
  EXPECT_LT((homogeneous.head<3>() - a * p).norm(), 1e-12);
  EXPECT_EQ(a.matrix().row(3), Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0));
}

TEST(Se3, ConjugationMovesTheTwist)
{
  // T exp(xi) T^-1 = exp(Ad(T) xi): true only if translation and rotation parts are in the documented order.
  std::mt19937 random(6);
  for (int n = 0; n < 20; ++n) {
    const SE3 pose = randomPose(random);
    const Vector6 twist = randomTwist(random, 1.0, 0.8);
    Vector6 moved;
    moved.tail<3>() = pose.rotation * twist.tail<3>();
    moved.head<3>() = pose.rotation * twist.head<3>() + pose.translation.cross(Eigen::Vector3d(moved.tail<3>()));
    EXPECT_LT(difference(pose * exp(twist) * pose.inverse(), exp(moved)), 1e-10);
  }
}

TEST(Se3, DerivativeOfALeftPerturbation)
{
  // d(exp(delta) q)/d(delta) = [I, -[q]x] (Eq. 11)
  const Eigen::Vector3d q(3.0, -4.0, 5.0);
  Eigen::Matrix<double, 3, 6> analytic;
  analytic << Eigen::Matrix3d::Identity(), -skew(q);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kStep * Vector6::Unit(i);
    const Eigen::Vector3d numeric = (exp(step) * q - exp(Vector6(-step)) * q) / (2.0 * kStep);
    EXPECT_LT((numeric - analytic.col(i)).norm(), 1e-8) << "column " << i;
  }
}

TEST(Se3, RotationAngleIsAccurateWhenSmall)
{
  for (const double angle : {1e-12, 1e-9, 1e-5, 0.5, 3.0}) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.3).normalized();
    EXPECT_NEAR(rotationAngle(expSO3(angle * axis)) / angle, 1.0, 1e-6) << angle;
  }
}

TEST(Se3, NearestRotation)
{
  std::mt19937 random(7);
  for (int n = 0; n < 20; ++n) {
    const Eigen::Matrix3d rotation = randomPose(random).rotation;
    EXPECT_LT((nearestRotation(rotation) - rotation).norm(), 1e-12);
    EXPECT_LT((nearestRotation(1.3 * rotation) - rotation).norm(), 1e-12);
    const Eigen::Matrix3d mirrored = rotation * Eigen::Vector3d(1.0, 1.0, -0.1).asDiagonal();
    EXPECT_NEAR(nearestRotation(mirrored).determinant(), 1.0, 1e-12);
  }
}

TEST(Se3, IsTheSameFromAllThatPclGives)
{
  std::mt19937 random(13);
  const SE3 pose = exp(randomTwist(random, 2.0, 1.0));
  EXPECT_EQ(SE3(pose.matrix()).matrix(), pose.matrix());
  EXPECT_EQ(SE3(pose.isometry()).matrix(), pose.matrix());
  EXPECT_LT((SE3(pose.matrix<float>()).matrix() - pose.matrix()).norm(), 1e-6);
}

TEST(Se3, KnowsWhetherItIsFinite)
{
  SE3 pose;
  EXPECT_TRUE(pose.isFinite());
  pose.translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose.isFinite());
  pose = SE3();
  pose.rotation(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pose.isFinite());
}

}  // namespace
}  // namespace pcl_floam::test
