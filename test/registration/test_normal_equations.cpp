// H and b against numeric derivatives of the cost, and what is made of them.
#include "registration/ceres_solver.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

Eigen::Vector3d randomVector(std::mt19937& random, double limit)
{
  return {uniform(random, limit), uniform(random, limit), uniform(random, limit)};
}

/// Correspondences that a pose fits up to \p noise.
Correspondences makeCorrespondences(const SE3& pose, double noise, std::size_t edges = 300, std::size_t planes = 700)
{
  std::mt19937 random(1);
  Correspondences all;
  const auto fill = [&](auto& correspondences, std::size_t count) {
    correspondences.resize(count);
    for (auto& c : correspondences) {
      c.point = randomVector(random, 15.0);
      c.weight = 1.0 + uniform(random, 0.5);
      c.factor = {pose * c.point + randomVector(random, noise), randomVector(random, 1.0).normalized()};
    }
  };
  fill(all.edges, edges);
  fill(all.planes, planes);
  return all;
}

class NormalEquationsTest : public testing::Test {
protected:
  NormalEquations equationsAt(const SE3& pose) const
  {
    return buildNormalEquations(problem_, pose, correspondences_, {0.2, 0.1});
  }
  double costAfter(const Vector6& step) const { return equationsAt(exp(step) * pose_).cost; }

  SE3 pose_ = exp((Vector6() << 1.0, -2.0, 0.5, 0.1, -0.2, 0.9).finished());
  FeatureTarget target_;
  RegistrationParameters parameters_;
  RegistrationProblem problem_{target_, parameters_, Eigen::Vector3d::Zero()};
  Correspondences correspondences_ = makeCorrespondences(pose_, 0.1);
};

TEST_F(NormalEquationsTest, GradientIsTheDerivativeOfTheRobustCost)
{
  for (const RobustKernel kernel :
       {RobustKernel::none, RobustKernel::huber, RobustKernel::cauchy, RobustKernel::geman_mcclure}) {
    parameters_.kernel = kernel;
    const Vector6 gradient = equationsAt(pose_).gradient;
    for (int i = 0; i < 6; ++i) {
      const Vector6 step = 1e-6 * Vector6::Unit(i);
      const double numeric = (costAfter(step) - costAfter(-step)) / 2e-6;
      EXPECT_NEAR(gradient[i], numeric, 1e-5 * gradient.norm()) << toString(kernel) << ' ' << i;
    }
  }
}

TEST_F(NormalEquationsTest, InformationIsTheHessianOfTheCostAtTheOptimum)
{
  parameters_.kernel = RobustKernel::none;
  correspondences_ = makeCorrespondences(pose_, 1e-4);
  const Matrix6 information = equationsAt(pose_).information;
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Vector6 a = kStep * Vector6::Unit(i);
      const Vector6 b = kStep * Vector6::Unit(j);
      const double numeric =
          (costAfter(a + b) - costAfter(a - b) - costAfter(b - a) + costAfter(-a - b)) / (4.0 * kStep * kStep);
      EXPECT_NEAR(information(i, j), numeric, 1e-3 * std::sqrt(information(i, i) * information(j, j)));
    }
  }
}

TEST_F(NormalEquationsTest, SumsAreTheSameBitsForEveryNumberOfThreads)
{
  const NormalEquations one = equationsAt(pose_);
  for (const int threads : {2, 3, 7}) {
    problem_.threads = threads;
    const NormalEquations many = equationsAt(pose_);
    EXPECT_EQ(one.information, many.information);
    EXPECT_EQ(one.gradient, many.gradient);
    EXPECT_EQ(one.cost, many.cost);
  }
}

TEST_F(NormalEquationsTest, CorrespondencesWithoutWeightDoNotCount)
{
  const NormalEquations before = equationsAt(pose_);
  correspondences_.edges.emplace_back();
  correspondences_.edges.back().point = Eigen::Vector3d(1.0, 2.0, 3.0);
  correspondences_.edges.back().factor = {Eigen::Vector3d(9.0, 9.0, 9.0), Eigen::Vector3d::UnitX()};
  const NormalEquations after = equationsAt(pose_);
  EXPECT_EQ(before.edges, 300);
  EXPECT_EQ(after.edges, 300);
  EXPECT_DOUBLE_EQ(before.cost, after.cost);
}

TEST_F(NormalEquationsTest, NewtonStepsAndCeresReachTheSameOptimum)
{
  for (const RobustKernel kernel : {RobustKernel::none, RobustKernel::cauchy}) {
    parameters_.kernel = kernel;
    const KernelScales scales{0.3, 0.3};
    const SE3 start = exp((Vector6() << 0.05, -0.03, 0.02, 0.004, -0.003, 0.002).finished()) * pose_;
    SE3 newton = start;
    SE3 ceres = start;
    for (int i = 0; i < 30; ++i) {
      const NormalEquations equations = buildNormalEquations(problem_, newton, correspondences_, scales);
      newton = exp(InformationAnalysis(equations, 0.0).step()) * newton;
      ceres = exp(solveWithCeres(problem_, ceres, correspondences_, scales)) * ceres;
    }
    EXPECT_LT(log(newton.inverse() * ceres).norm(), 5e-5) << toString(kernel);
    EXPECT_LT(equationsAt(newton).gradient.norm(), equationsAt(start).gradient.norm());
  }
}

TEST_F(NormalEquationsTest, KernelScaleFollowsTheResiduals)
{
  parameters_.kernel_scale = 0.01;
  const KernelScales narrow = adaptKernelScales(problem_, pose_, correspondences_);
  const KernelScales wide = adaptKernelScales(problem_, pose_, makeCorrespondences(pose_, 1.0));
  EXPECT_NEAR(wide.edge / narrow.edge, 10.0, 1e-6);
  EXPECT_NEAR(wide.plane / narrow.plane, 10.0, 1e-6);
  const KernelScales exact = adaptKernelScales(problem_, pose_, makeCorrespondences(pose_, 0.0));
  EXPECT_DOUBLE_EQ(exact.edge, 0.01);
  EXPECT_DOUBLE_EQ(exact.plane, 0.01);
}

TEST_F(NormalEquationsTest, CovarianceIsTheInverseInformationTimesTheVariance)
{
  parameters_.kernel = RobustKernel::none;
  const NormalEquations equations = equationsAt(pose_);
  const InformationAnalysis analysis(equations, 1e-4);
  const double variance = equations.weighted_squares / equations.weight;
  const Eigen::Matrix<double, 6, 6> expected = variance * Eigen::Matrix<double, 6, 6>(equations.information).inverse();
  EXPECT_LT((analysis.covariance() - expected).norm(), 1e-9 * expected.norm());
  EXPECT_TRUE(analysis.weakDirections().empty());
}

TEST_F(NormalEquationsTest, AWallLeavesThreeDirectionsWeak)
{
  correspondences_ = makeCorrespondences(SE3(), 0.05, 0, 500);
  for (auto& c : correspondences_.planes) {
    c.point.z() = 0.0;
    c.factor.center = Eigen::Vector3d(0.0, 0.0, 0.1);
    c.factor.normal = Eigen::Vector3d::UnitZ();
  }
  const NormalEquations equations = equationsAt(SE3());
  const InformationAnalysis analysis(equations, 1e-4);
  const auto weak = analysis.weakDirections();
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
  EXPECT_TRUE(analysis.covariance().allFinite());
  EXPECT_GT(analysis.covariance()(0, 0), 1e3 * analysis.covariance()(2, 2));
}

TEST_F(NormalEquationsTest, NoiseAlongWeakDirectionsIsNotFollowed)
{
  // Normals that are a little off seem to tell something of x and y, and noise in the distances turns it into metres.
  std::mt19937 random(3);
  correspondences_ = makeCorrespondences(SE3(), 0.0, 0, 500);
  for (auto& c : correspondences_.planes) {
    c.point.z() = 0.0;
    c.factor.center = c.point + Eigen::Vector3d(0.0, 0.0, 0.1 + uniform(random, 0.05));
    c.factor.normal = Eigen::Vector3d(uniform(random, 0.005), uniform(random, 0.005), 1.0).normalized();
  }
  parameters_.kernel = RobustKernel::none;
  const NormalEquations equations = equationsAt(SE3());
  const Vector6 followed = InformationAnalysis(equations, 0.0).step();
  const InformationAnalysis analysis(equations, 1e-4);
  EXPECT_EQ(analysis.weakDirections().size(), 3U);
  EXPECT_GT(followed.head<2>().norm(), 0.05);
  EXPECT_LT(analysis.step().head<2>().norm(), 0.005);
  EXPECT_NEAR(analysis.step()[2], 0.1, 0.01);
}

}  // namespace
}  // namespace pcl_floam::test
