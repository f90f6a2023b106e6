// Which directions the correspondences constrain, and what follows where they don't.
#include "registration/information_analysis.h"
#include "registration/net_information.h"
#include "registration/normal_equations.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>

namespace pcl_floam::test {
namespace {

/// Points of a level floor, which the map has higher.
Correspondences floorOf(double higher)
{
  std::mt19937 random(1);
  Correspondences correspondences;
  correspondences.planes.resize(500);
  for (auto& c : correspondences.planes) {
    c.point = randomVector(random, 15.0);
    c.point.z() = 0.0;
    c.weight = 1.0 + uniform(random, 0.5);
    c.factor = {FeatureKind::plane, Eigen::Vector3d(0.0, 0.0, higher), Eigen::Vector3d::UnitZ()};
  }
  return correspondences;
}

class InformationAnalysisTest : public testing::Test {
protected:
  NormalEquations equationsOf(const Correspondences& correspondences) const
  {
    return buildNormalEquations(problem_, correspondences, {0.2, 0.1});
  }

  FeatureTarget target_;
  RegistrationParameters parameters_;
  RegistrationProblem problem_{target_, parameters_, Eigen::Vector3d::Zero()};
};

TEST_F(InformationAnalysisTest, AWallLeavesThreeDirectionsWeak)
{
  const NormalEquations equations = equationsOf(floorOf(0.1));
  const InformationAnalysis analysis(equations, 1e-4);
  const auto weak = analysis.weakDirections(1e-4);
  ASSERT_EQ(weak.size(), 3U);
  for (const WeakDirection& direction : weak) {  // x, y and the rotation about z
    EXPECT_NEAR(direction.direction[2], 0.0, 1e-9);
    EXPECT_NEAR(direction.direction[3], 0.0, 1e-9);
    EXPECT_NEAR(direction.direction[4], 0.0, 1e-9);
  }
  const Vector6 step = analysis.step();
  EXPECT_NEAR(step[2], 0.1, 1e-9);
  EXPECT_NEAR(step[0], 0.0, 1e-9);
  EXPECT_NEAR(step[1], 0.0, 1e-9);
  EXPECT_NEAR(step[5], 0.0, 1e-9);
  EXPECT_TRUE(analysis.covariance(1.0).allFinite());
  EXPECT_GT(analysis.covariance(1.0)(0, 0), 1e3 * analysis.covariance(1.0)(2, 2));
}

/// The walls, floor and ceiling of a corridor along x whose fitted normals are off by some standard deviation, and the
/// door frames across it.
Correspondences corridorOf(double tilt, std::size_t frames)
{
  std::mt19937 random(4);
  std::normal_distribution<double> off(0.0, tilt);
  Correspondences correspondences;
  for (std::size_t i = 0; i < 2000; ++i) {
    const bool on_frame = i < frames;
    const Eigen::Vector3d side = i % 2 == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d other = i % 2 == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    Correspondence c;
    c.point = uniform(random, 15.0) * Eigen::Vector3d::UnitX() + (i % 4 < 2 ? 1.5 : -1.5) * side +
              uniform(random, 1.5) * other;
    c.weight = 1.0;
    const Eigen::Vector3d normal = side + off(random) * Eigen::Vector3d::UnitX() + off(random) * other;
    c.factor = {FeatureKind::plane, c.point + randomVector(random, 0.01),
                on_frame ? Eigen::Vector3d(Eigen::Vector3d::UnitX()) : normal};
    c.factor.tilt = {tilt * Eigen::Vector3d::UnitX(), tilt * other};
    correspondences.planes.push_back(c);
  }
  return correspondences;
}

TEST_F(InformationAnalysisTest, WhatTheNormalsNoiseFeignsIsKnown)
{
  const NormalEquations equations = equationsOf(corridorOf(0.03, 0));
  EXPECT_GT(equations.information(0, 0), 0.0);
  EXPECT_NEAR(equations.noise_information(0, 0) / equations.information(0, 0), 1.0, 0.1);
  EXPECT_LT(equations.noise_information(1, 1), 0.01 * equations.information(1, 1));
}

TEST_F(InformationAnalysisTest, NetOfNoiseASmoothCorridorTellsNothingOfTheWayAlongAndDoorsTellTheirPart)
{
  const auto netAlong = [&](std::size_t frames) {
    const NormalEquations equations = equationsOf(corridorOf(0.03, frames));
    const Matrix6 net = withoutNoise(equations).steps.information;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> net_alone(net);
    EXPECT_GT(net_alone.eigenvalues()[0], -1e-9 * equations.weight);
    EXPECT_NEAR(net(1, 1) / equations.information(1, 1), 1.0, 0.01);
    return net(0, 0) / equations.weight;
  };
  constexpr double kOfOne = 1.0 / 2000.0;
  EXPECT_LT(netAlong(0), 0.1 * 0.03 * 0.03);
  // Noise may be half as much again as it is in the mean.
  const double net = 20.0 - 0.5 * 0.03 * 0.03 * 2000.0;
  EXPECT_NEAR(netAlong(20), net * kOfOne, 0.1 * net * kOfOne);
}

TEST_F(InformationAnalysisTest, WhatNoiseMakesCountsNeitherInHNorInTheGradient)
{
  NormalEquations equations = equationsOf(corridorOf(0.0, 20));
  equations.noise_information = 0.25 * equations.information;
  constexpr double kShare = 0.625;  // noise may be half as much again as it is in the mean
  const NetEquations net = withoutNoise(equations);
  const double all = equations.information.norm();
  EXPECT_LT((net.steps.information - kShare * equations.information).norm(), 1e-4 * all);
  EXPECT_LT((net.known.information - kShare * kShare * equations.information).norm(), 1e-4 * all);
  EXPECT_LT((net.steps.gradient - kShare * equations.gradient).norm(), 1e-4 * equations.gradient.norm());
}

TEST_F(InformationAnalysisTest, WithoutNoiseEquationsAreThemselves)
{
  const NormalEquations equations = equationsOf(corridorOf(0.0, 20));
  const NormalEquations net = withoutNoise(equations).known;
  EXPECT_LT((net.information - equations.information).norm(), 1e-4 * equations.information.norm());
  EXPECT_LT((net.gradient - equations.gradient).norm(), 1e-4 * equations.gradient.norm());
  EXPECT_TRUE(untoldMotions(net, equations).directions.empty());
  EXPECT_TRUE(untoldMotions(net, equations).onto.isZero());
}

TEST_F(InformationAnalysisTest, UntoldIsTheWayAlongASmoothCorridorAlone)
{
  const NormalEquations equations = equationsOf(corridorOf(0.03, 0));
  const UntoldMotions untold = untoldMotions(withoutNoise(equations).steps, equations);
  ASSERT_EQ(untold.directions.size(), 1U);
  EXPECT_GT(std::abs(untold.directions.front().direction[0]), 0.99);
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square onto = untold.onto;
  EXPECT_LT((onto * onto - onto).norm(), 1e-6);  // a projector, of one motion
  EXPECT_NEAR(onto.trace(), 1.0, 1e-6);

  Matrix6 odometer = Matrix6::Zero();
  odometer(0, 0) = equations.information(0, 0);
  EXPECT_TRUE(untoldMotions(withoutNoise(equations).steps, equations, odometer).directions.empty());
}

TEST_F(InformationAnalysisTest, TheWayAlongASmoothCorridorIsWeakAndThatAlongOneWithDoorsIsNot)
{
  const NormalEquations smooth = equationsOf(corridorOf(0.03, 0));
  const InformationAnalysis analysis(smooth, 2e-4);
  const auto weak = analysis.weakDirections(2e-4);
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_GT(std::abs(weak.front().direction[0]), 0.99);
  EXPECT_LT(std::abs(analysis.step()[0]), 1e-3);
  EXPECT_GT(analysis.covariance(1.0)(0, 0), 100.0 * analysis.covariance(1.0)(1, 1));
  EXPECT_TRUE(InformationAnalysis(smooth, 0.0).weakDirections(0.0).empty());

  EXPECT_TRUE(InformationAnalysis(equationsOf(corridorOf(0.03, 20)), 2e-4).weakDirections(2e-4).empty());
}

TEST_F(InformationAnalysisTest, TheNoiseIsThatOfThePlanesThatAreLinked)
{
  const NormalEquations all = equationsOf(corridorOf(0.03, 0));
  for (const std::size_t stride : {2U, 3U, 4U}) {
    Correspondences some = corridorOf(0.03, 0);
    for (std::size_t i = 0; i < some.planes.size(); ++i) {
      some.planes[i].weight = i % stride == 0 ? 1.0 : 0.0;
    }
    const NormalEquations equations = equationsOf(some);
    EXPECT_NEAR(equations.noise_information(0, 0) / equations.weight, all.noise_information(0, 0) / all.weight,
                0.1 * all.noise_information(0, 0) / all.weight)
        << stride;
  }
}

TEST_F(InformationAnalysisTest, AWallWithoutAThresholdHasAPositiveCovarianceAndAFiniteStep)
{
  const NormalEquations equations = equationsOf(floorOf(0.1));
  const InformationAnalysis analysis(equations, 0.0);
  EXPECT_LT(analysis.step().norm(), 0.2);
  EXPECT_GT(analysis.covariance(1.0).diagonal().minCoeff(), 0.0);
  EXPECT_TRUE(analysis.weakDirections(0.0).empty());
}

TEST_F(InformationAnalysisTest, NoiseAlongWeakDirectionsIsNotFollowed)
{
  // Normals that are a little off seem to tell something of x and y, and noise in the distances turns it into metres.
  std::mt19937 random(3);
  Correspondences correspondences = floorOf(0.1);
  for (auto& c : correspondences.planes) {
    c.factor.center = c.point + Eigen::Vector3d(0.0, 0.0, 0.1 + uniform(random, 0.05));
    c.factor.direction = Eigen::Vector3d(uniform(random, 0.005), uniform(random, 0.005), 1.0).normalized();
  }
  parameters_.kernel = RobustKernel::none;
  const NormalEquations equations = equationsOf(correspondences);
  const Vector6 followed = InformationAnalysis(equations, 0.0).step();
  const InformationAnalysis analysis(equations, 1e-4);
  EXPECT_EQ(analysis.weakDirections(1e-4).size(), 3U);
  EXPECT_GT(followed.head<2>().norm(), 0.05);
  EXPECT_LT(analysis.step().head<2>().norm(), 0.005);
  EXPECT_NEAR(analysis.step()[2], 0.1, 0.01);
}

}  // namespace
}  // namespace pcl_floam::test
