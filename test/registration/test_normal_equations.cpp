// H and b against numeric derivatives of the cost, and the steps of both solvers.
#include "registration/ceres_solver.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"
#include "registration/sweep_step.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace pcl_floam::test {
namespace {

/// A scan, and correspondences that a trajectory of the sensor fits up to \p noise.
struct Scan {
  std::vector<Feature> edges;
  std::vector<Feature> planes;
  Correspondences factors;

  Scan(const SweepTrajectory& trajectory, double noise, std::size_t edge_count = 300, std::size_t plane_count = 700)
  {
    std::mt19937 random(1);
    const auto fill = [&](std::vector<Feature>& features, auto& correspondences, std::size_t count) {
      correspondences.resize(count);
      for (auto& c : correspondences) {
        const Eigen::Vector3f point = randomVector(random, 15.0).cast<float>();
        features.push_back({point.x(), point.y(), point.z(), static_cast<float>(0.5 + uniform(random, 0.5))});
        c.weight = 1.0 + uniform(random, 0.5);
        c.factor = {trajectory.at(point.cast<double>(), features.back().time) + randomVector(random, noise),
                    randomVector(random, 1.0).normalized()};
      }
    };
    fill(edges, factors.edges, edge_count);
    fill(planes, factors.planes, plane_count);
  }

  /// With the points where a trajectory puts them.
  [[nodiscard]] Correspondences along(const SweepTrajectory& trajectory) const
  {
    Correspondences moved = factors;
    const auto move = [&](const std::vector<Feature>& features, auto& correspondences) {
      for (std::size_t i = 0; i < features.size(); ++i) {
        const Feature& f = features[i];
        correspondences[i].point = trajectory.at(Eigen::Vector3d(f.x, f.y, f.z), f.time);
        correspondences[i].since_reference = trajectory.sinceReference(f.time);
      }
    };
    move(edges, moved.edges);
    move(planes, moved.planes);
    return moved;
  }
};

class NormalEquationsTest : public testing::Test {
protected:
  NormalEquations equationsOf(const Correspondences& correspondences) const
  {
    return buildNormalEquations(problem_, correspondences, scales_);
  }
  NormalEquations equationsAt(const SweepTrajectory& trajectory) const { return equationsOf(scan_.along(trajectory)); }
  double costAfter(const Vector6& pose_step, const Vector6& twist_step = Vector6::Zero()) const
  {
    return equationsAt(trajectory_.perturbed(pose_step, twist_step)).cost;
  }
  SweepTrajectory perturbedStart() const
  {
    return trajectory_.perturbed((Vector6() << 0.05, -0.03, 0.02, 0.004, -0.003, 0.002).finished(),
                                 (Vector6() << -0.02, 0.04, 0.01, 0.002, 0.005, -0.004).finished());
  }

  SweepTrajectory trajectory_{exp((Vector6() << 1.0, -2.0, 0.5, 0.1, -0.2, 0.9).finished()),
                              (Vector6() << 0.9, 0.1, -0.2, 0.05, -0.1, 0.15).finished(), 0.5};
  FeatureTarget target_;
  RegistrationParameters parameters_;
  RegistrationProblem problem_{target_, parameters_, Eigen::Vector3d::Zero()};
  KernelScales scales_{0.2, 0.1};
  Scan scan_{trajectory_, 0.1};
};

TEST_F(NormalEquationsTest, GradientsAreTheDerivativesOfTheRobustCost)
{
  for (const RobustKernel kernel :
       {RobustKernel::none, RobustKernel::huber, RobustKernel::cauchy, RobustKernel::geman_mcclure}) {
    parameters_.kernel = kernel;
    const NormalEquations equations = equationsAt(trajectory_);
    for (int i = 0; i < 6; ++i) {
      const Vector6 step = 1e-6 * Vector6::Unit(i);
      const Vector6 none = Vector6::Zero();
      EXPECT_NEAR(equations.gradient[i], (costAfter(step) - costAfter(-step)) / 2e-6, 1e-5 * equations.gradient.norm())
          << toString(kernel) << ' ' << i;
      // Exact to first order in the motion during the sweep, which here is as fast as a car's.
      EXPECT_NEAR(equations.twist_gradient[i], (costAfter(none, step) - costAfter(none, -step)) / 2e-6,
                  0.05 * equations.twist_gradient.norm())
          << toString(kernel) << ' ' << i;
    }
  }
}

TEST_F(NormalEquationsTest, SumsAreTheHessianOfTheCostAtTheOptimum)
{
  parameters_.kernel = RobustKernel::none;
  trajectory_ = SweepTrajectory(trajectory_.pose(), 1e-3 * trajectory_.twist(), 0.5);
  scan_ = Scan(trajectory_, 1e-4);
  const NormalEquations equations = equationsAt(trajectory_);
  constexpr double kStep = 1e-3;
  const auto numeric = [&](int i, int j) {
    const auto cost = [&](double a, double b) {
      Vector6 pose = Vector6::Zero();
      Vector6 twist = Vector6::Zero();
      (i < 6 ? pose[i] : twist[i - 6]) += a * kStep;
      (j < 6 ? pose[j] : twist[j - 6]) += b * kStep;
      return costAfter(pose, twist);
    };
    return (cost(1, 1) - cost(1, -1) - cost(-1, 1) + cost(-1, -1)) / (4.0 * kStep * kStep);
  };
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = std::sqrt(equations.information(i, i) * equations.information(j, j));
      EXPECT_NEAR(equations.information(i, j), numeric(i, j), 2e-3 * scale);
      EXPECT_NEAR(equations.coupling(i, j), numeric(i, 6 + j), 2e-3 * scale);
      EXPECT_NEAR(equations.twist_information(i, j), numeric(6 + i, 6 + j), 2e-3 * scale);
    }
  }
}

TEST_F(NormalEquationsTest, ATwistThatFollowsThePoseReducesToIt)
{
  SweepModel model;
  model.freedom = SweepFreedom::follows_pose;
  model.sweep_per_motion = 0.8;
  const NormalEquations reduced = reducedToPose(equationsAt(trajectory_), model);
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = 1e-6 * Vector6::Unit(i);
    const double numeric = (costAfter(step, 0.8 * step) - costAfter(-step, -0.8 * step)) / 2e-6;
    EXPECT_NEAR(reduced.gradient[i], numeric, 1e-2 * reduced.gradient.norm());
  }
}

TEST_F(NormalEquationsTest, ItsInformationIsTheHessianAlongThatMotion)
{
  // From its start on all times are of one sign: pose and twist are coupled.
  const SweepTrajectory from_start(trajectory_.pose(), trajectory_.twist(), 0.0);
  const Scan exact(from_start, 0.0);
  SweepModel model;
  model.freedom = SweepFreedom::follows_pose;
  model.sweep_per_motion = 0.8;
  const NormalEquations reduced = reducedToPose(equationsOf(exact.along(from_start)), model);
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = 1e-4 * Vector6::Unit(i);
    const auto costAt = [&](double sign) {
      return equationsOf(exact.along(from_start.perturbed(sign * step, 0.8 * sign * step))).cost;
    };
    const double numeric = (costAt(1.0) + costAt(-1.0)) / 1e-8;  // the cost between them is zero
    EXPECT_NEAR(reduced.information(i, i) / numeric, 1.0, 1e-2);
  }
}

TEST_F(NormalEquationsTest, SumsAreTheSameBitsForEveryNumberOfThreads)
{
  const NormalEquations one = equationsAt(trajectory_);
  for (const int threads : {2, 3, 7}) {
    problem_.threads = threads;
    const NormalEquations many = equationsAt(trajectory_);
    EXPECT_EQ(one.information, many.information);
    EXPECT_EQ(one.gradient, many.gradient);
    EXPECT_EQ(one.cost, many.cost);
  }
}

TEST_F(NormalEquationsTest, CorrespondencesWithoutWeightDoNotCount)
{
  Correspondences correspondences = scan_.along(trajectory_);
  const NormalEquations before = equationsOf(correspondences);
  correspondences.edges.emplace_back();
  correspondences.edges.back().point = Eigen::Vector3d(1.0, 2.0, 3.0);
  correspondences.edges.back().factor = {Eigen::Vector3d(9.0, 9.0, 9.0), Eigen::Vector3d::UnitX()};
  const NormalEquations after = equationsOf(correspondences);
  EXPECT_EQ(before.edges, 300);
  EXPECT_EQ(after.edges, 300);
  EXPECT_DOUBLE_EQ(before.cost, after.cost);
}

TEST_F(NormalEquationsTest, NewtonStepsAndCeresReachTheSameOptimum)
{
  for (const RobustKernel kernel : {RobustKernel::none, RobustKernel::cauchy}) {
    parameters_.kernel = kernel;
    SweepTrajectory newton = perturbedStart();
    SweepTrajectory ceres = newton;
    for (int i = 0; i < 30; ++i) {
      const NormalEquations equations = buildNormalEquations(problem_, scan_.along(newton), scales_);
      newton = newton.perturbed(InformationAnalysis(equations, 0.0).step(), Vector6::Zero());
      const SweepStep step = solveWithCeres(problem_, SweepModel(), scan_.along(ceres), scales_, std::nullopt);
      EXPECT_TRUE(step.twist.isZero(0.0));
      ceres = ceres.perturbed(step.pose, step.twist);
    }
    EXPECT_LT(log(newton.pose().inverse() * ceres.pose()).norm(), 5e-5) << toString(kernel);
    EXPECT_LT(equationsAt(newton).gradient.norm(), 1e-3 * equationsAt(perturbedStart()).gradient.norm());
  }
}

TEST_F(NormalEquationsTest, NewtonStepsAndCeresReachTheSameMotionDuringTheSweep)
{
  for (const RobustKernel kernel : {RobustKernel::none, RobustKernel::cauchy}) {
    parameters_.kernel = kernel;
    scan_ = Scan(trajectory_, 0.02);
    SweepModel model;
    model.freedom = SweepFreedom::free;
    model.prior.pose = perturbedStart().pose();
    model.prior.twist = perturbedStart().twist();
    model.prior.translation = model.prior.rotation = {0.01, 0.01, 0.005};
    SweepTrajectory newton = perturbedStart();
    SweepTrajectory ceres = newton;
    for (int i = 0; i < 30; ++i) {
      const NormalEquations equations = buildNormalEquations(problem_, scan_.along(newton), scales_);
      const SweepStep step =
          FreeSweepSolver(equations, InformationAnalysis(equations, 0.0), model.prior, newton).step();
      newton = newton.perturbed(step.pose, step.twist);
      const NormalEquations of_ceres = buildNormalEquations(problem_, scan_.along(ceres), scales_);
      const double variance = independentVariance(InformationAnalysis(of_ceres, 0.0));
      const SweepStep other =
          solveWithCeres(problem_, model, scan_.along(ceres), scales_, motionPriorTerm(model.prior, ceres, variance));
      ceres = ceres.perturbed(other.pose, other.twist);
    }
    EXPECT_LT(log(newton.pose().inverse() * ceres.pose()).norm(), 1e-4) << toString(kernel);
    EXPECT_LT((newton.twist() - ceres.twist()).norm(), 2e-4) << toString(kernel);
    EXPECT_LT((newton.twist() - trajectory_.twist()).norm(), 0.5 * (newton.twist() - model.prior.twist).norm());
  }
}

TEST_F(NormalEquationsTest, APriorThatIsSureWins)
{
  MotionPrior prior;
  prior.pose = perturbedStart().pose();
  prior.twist = perturbedStart().twist();
  prior.translation = prior.rotation = {1e-12, 1e-12, 0.0};
  SweepTrajectory result = trajectory_;
  for (int i = 0; i < 5; ++i) {
    const NormalEquations equations = equationsAt(result);
    const FreeSweepSolver solver(equations, InformationAnalysis(equations, 1e-4), prior, result);
    result = result.perturbed(solver.step().pose, solver.step().twist);
    EXPECT_LT(solver.poseCovariance().norm(), 1e-11);
  }
  EXPECT_LT(log(result.pose().inverse() * prior.pose).norm(), 1e-6);
  EXPECT_LT((result.twist() - prior.twist).norm(), 1e-6);
}

TEST_F(NormalEquationsTest, WhatTheWeightsAddUpToDoesNotChangeThePriorsSay)
{
  MotionPrior prior;
  prior.pose = perturbedStart().pose();
  prior.twist = perturbedStart().twist();
  prior.translation = prior.rotation = {1e-5, 1e-5, 0.0};
  const auto stepWithWeights = [&](double factor) {
    Correspondences correspondences = scan_.along(trajectory_);
    for (auto& c : correspondences.edges) {
      c.weight *= factor;
    }
    for (auto& c : correspondences.planes) {
      c.weight *= factor;
    }
    const NormalEquations equations = equationsOf(correspondences);
    return FreeSweepSolver(equations, InformationAnalysis(equations, 1e-4), prior, trajectory_).step();
  };
  EXPECT_GT(stepWithWeights(1.0).pose.norm(), 0.01);
  EXPECT_LT((stepWithWeights(1.0).pose - stepWithWeights(1e-3).pose).norm(), 1e-9);
  EXPECT_LT((stepWithWeights(1.0).twist - stepWithWeights(1e-3).twist).norm(), 1e-9);
}

TEST_F(NormalEquationsTest, APriorThatKnowsNothingIsNotSeen)
{
  MotionPrior prior;
  prior.translation = prior.rotation = {1e12, 1e12, 0.0};
  const NormalEquations equations = equationsAt(perturbedStart());
  const FreeSweepSolver solver(equations, InformationAnalysis(equations, 1e-4), prior, perturbedStart());
  Eigen::Matrix<double, 12, 12> sums;
  sums << equations.information, equations.coupling, equations.coupling, equations.twist_information;
  Eigen::Matrix<double, 12, 1> gradient;
  gradient << equations.gradient, equations.twist_gradient;
  const Eigen::Matrix<double, 12, 1> expected = -sums.ldlt().solve(gradient);
  EXPECT_LT((solver.step().pose - expected.head<6>()).norm(), 1e-6);
  EXPECT_LT((solver.step().twist - expected.tail<6>()).norm(), 1e-6);
}

TEST_F(NormalEquationsTest, KernelScaleFollowsTheResiduals)
{
  parameters_.kernel_scale = 0.01;
  const auto scalesAt = [&](double noise) {
    return adaptKernelScales(problem_, Scan(trajectory_, noise).along(trajectory_));
  };
  EXPECT_NEAR(scalesAt(1.0).edge / scalesAt(0.1).edge, 10.0, 1e-3);
  EXPECT_NEAR(scalesAt(1.0).plane / scalesAt(0.1).plane, 10.0, 1e-3);
  EXPECT_DOUBLE_EQ(scalesAt(0.0).edge, 0.01);
  EXPECT_DOUBLE_EQ(scalesAt(0.0).plane, 0.01);
}

TEST_F(NormalEquationsTest, KernelScaleIsThreeStandardDeviationsByTheMedian)
{
  parameters_.kernel_scale = 0.01;
  Correspondences correspondences;
  for (const double residual : {0.9, 0.01, 0.02, -0.8, 0.1, 0.7, -0.03}) {
    Correspondence<PlaneFactor> c;
    c.factor = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
    c.point = Eigen::Vector3d(3.0, 4.0, residual);
    c.weight = 1.0;
    correspondences.planes.push_back(c);
  }
  EXPECT_NEAR(adaptKernelScales(problem_, correspondences).plane, 3.0 * 1.4826 * 0.1, 1e-9);
}

TEST_F(NormalEquationsTest, TheScaleOfEdgesIsBoundedByThatOfThePlanesOrThePosesUncertainty)
{
  constexpr double kEdgesOff = 0.8;
  const auto scalesWith = [&](std::size_t edges, std::size_t planes, double uncertainty = 0.0) {
    Correspondences correspondences = Scan(trajectory_, 0.0, edges, planes).along(trajectory_);
    for (auto& c : correspondences.edges) {
      c.factor.center += kEdgesOff * c.factor.direction.unitOrthogonal();
    }
    return adaptKernelScales(problem_, correspondences, uncertainty);
  };
  const double smallest = problem_.parameters.kernel_scale;
  EXPECT_NEAR(scalesWith(2, 500).edge, smallest, 1e-9);
  EXPECT_NEAR(scalesWith(39, 500).edge, smallest, 1e-9);
  EXPECT_NEAR(scalesWith(40, 500).edge, 3.5 * smallest, 1e-9) << "many may still be one lorry's";
  EXPECT_NEAR(scalesWith(40, 500, 0.3).edge, 3.5 * 0.3, 1e-9);
  EXPECT_NEAR(scalesWith(40, 500, 9.0).edge, 3.0 * 1.4826 * kEdgesOff, 1e-5);
  EXPECT_NEAR(scalesWith(39, 39).edge, 3.0 * 1.4826 * kEdgesOff, 1e-6) << "so few planes are no measure either";
  EXPECT_NEAR(scalesWith(0, 500).edge, smallest, 1e-9);
  EXPECT_NEAR(scalesWith(2, 500, 0.3).edge, 0.3, 1e-9) << "the pose may be off by as much";
  EXPECT_NEAR(scalesWith(2, 500, 9.0).edge, 3.0 * 1.4826 * kEdgesOff, 1e-5) << "they are not as far off as it may be";

  // Good edges among bad planes keep their own.
  Correspondences correspondences = Scan(trajectory_, 0.0, 10, 500).along(trajectory_);
  for (auto& c : correspondences.planes) {
    c.factor.center += 0.5 * c.factor.normal;
  }
  EXPECT_NEAR(adaptKernelScales(problem_, correspondences).edge, smallest, 1e-9);
  EXPECT_NEAR(adaptKernelScales(problem_, correspondences).plane, 3.0 * 1.4826 * 0.5, 1e-6);
}

TEST_F(NormalEquationsTest, CovarianceIsTheInverseInformationTimesTheVariance)
{
  parameters_.kernel = RobustKernel::none;
  const NormalEquations equations = equationsAt(trajectory_);
  const InformationAnalysis analysis(equations, 1e-4);
  const Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>(equations.information).inverse();
  const Eigen::Matrix<double, 6, 6> expected = analysis.poseVariance() * inverse;
  EXPECT_LT((analysis.covariance() - expected).norm(), 1e-9 * expected.norm());
  EXPECT_NEAR(analysis.poseVariance() / (analysis.residualVariance() * analysis.meanWeight()), 7.0, 1e-9);
  EXPECT_TRUE(analysis.weakDirections().empty());
}

}  // namespace
}  // namespace pcl_floam::test
