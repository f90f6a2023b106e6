// H and b against numeric derivatives of the cost, and the steps of both solvers.
#include "registration/ceres_solver.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"
#include "support/random_motion.h"
#include "support/seen_place.h"

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
    const auto fill = [&](FeatureKind kind, std::vector<Feature>& features, auto& correspondences, std::size_t count) {
      correspondences.resize(count);
      for (auto& c : correspondences) {
        const Eigen::Vector3f point = randomVector(random, 15.0).cast<float>();
        features.push_back({point.x(), point.y(), point.z(), static_cast<float>(0.5 + uniform(random, 0.5))});
        c.weight = 1.0 + uniform(random, 0.5);
        c.factor = {kind, placeOf(trajectory, point.cast<double>(), features.back().time) + randomVector(random, noise),
                    randomVector(random, 1.0).normalized()};
      }
    };
    fill(FeatureKind::edge, edges, factors.edges, edge_count);
    fill(FeatureKind::plane, planes, factors.planes, plane_count);
  }

  /// With the points where a trajectory puts them.
  [[nodiscard]] Correspondences along(const SweepTrajectory& trajectory) const
  {
    Correspondences moved = factors;
    const auto move = [&](const std::vector<Feature>& features, auto& correspondences) {
      for (std::size_t i = 0; i < features.size(); ++i) {
        const Feature& f = features[i];
        correspondences[i].point = placeOf(trajectory, Eigen::Vector3d(f.x, f.y, f.z), f.time);
        correspondences[i].since_reference = trajectory.sinceReference(f.time);
      }
    };
    move(edges, moved.edges);
    move(planes, moved.planes);
    return moved;
  }
};

/// A perturbation of the pose, and one of the motion over the sweep, both on the left.
SweepTrajectory perturbed(const SweepTrajectory& trajectory, const Vector6& pose_step, const Vector6& twist_step)
{
  const double before = trajectory.sinceReference(0.0);
  const double after = trajectory.sinceReference(1.0);
  const SE3 start = exp(pose_step + before * twist_step) * trajectory.pose() * exp(before * trajectory.twist());
  const SE3 end = exp(pose_step + after * twist_step) * trajectory.pose() * exp(after * trajectory.twist());
  const Vector6 twist = log(start.inverse() * end);
  return SweepTrajectory(start * exp(-before * twist), twist, -before);
}

class NormalEquationsTest : public testing::Test {
protected:
  NormalEquations equationsOf(const Correspondences& correspondences) const
  {
    return buildNormalEquations(problem_, correspondences, scales_);
  }
  NormalEquations equationsAt(const SweepTrajectory& trajectory) const { return equationsOf(scan_.along(trajectory)); }
  double costAfter(const Vector6& pose_step, const Vector6& twist_step = Vector6::Zero()) const
  {
    return equationsAt(perturbed(trajectory_, pose_step, twist_step)).cost;
  }
  SweepTrajectory perturbedStart() const
  {
    return trajectory_.perturbed((Vector6() << 0.05, -0.03, 0.02, 0.004, -0.003, 0.002).finished());
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
  model.follows_pose = true;
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
  model.follows_pose = true;
  model.sweep_per_motion = 0.8;
  const NormalEquations reduced = reducedToPose(equationsOf(exact.along(from_start)), model);
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = 1e-4 * Vector6::Unit(i);
    const auto costAt = [&](double sign) {
      return equationsOf(exact.along(perturbed(from_start, sign * step, 0.8 * sign * step))).cost;
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
  correspondences.edges.back().factor = {FeatureKind::edge, Eigen::Vector3d(9.0, 9.0, 9.0), Eigen::Vector3d::UnitX()};
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
      newton = newton.perturbed(InformationAnalysis(equations, 0.0).step());
      ceres = ceres.perturbed(solveWithCeres(problem_, SweepModel(), scan_.along(ceres), scales_));
    }
    EXPECT_LT(log(newton.pose().inverse() * ceres.pose()).norm(), 5e-5) << toString(kernel);
    EXPECT_LT(equationsAt(newton).gradient.norm(), 1e-3 * equationsAt(perturbedStart()).gradient.norm());
  }
}

TEST_F(NormalEquationsTest, NewtonStepsAndCeresReachTheSameMotionDuringTheSweep)
{
  SweepModel model;
  model.follows_pose = true;
  model.held_pose = trajectory_.pose() * exp(-1.25 * trajectory_.twist());
  model.sweep_per_motion = 0.8;
  const auto along = [&](const SE3& pose) {
    return SweepTrajectory(pose, model.sweep_per_motion * log(model.held_pose.inverse() * pose), 0.5);
  };
  for (const RobustKernel kernel : {RobustKernel::none, RobustKernel::cauchy}) {
    parameters_.kernel = kernel;
    SweepTrajectory newton = along(perturbedStart().pose());
    SweepTrajectory ceres = newton;
    for (int i = 0; i < 30; ++i) {
      const NormalEquations equations = buildNormalEquations(problem_, scan_.along(newton), scales_);
      newton = along(newton.perturbed(InformationAnalysis(reducedToPose(equations, model), 0.0).step()).pose());
      ceres = along(ceres.perturbed(solveWithCeres(problem_, model, scan_.along(ceres), scales_)).pose());
    }
    EXPECT_LT(log(newton.pose().inverse() * ceres.pose()).norm(), 1e-4) << toString(kernel);
  }
}

TEST_F(NormalEquationsTest, KernelScaleFollowsTheResiduals)
{
  const auto scalesAt = [&](double noise) { return adaptKernelScales(Scan(trajectory_, noise).along(trajectory_)); };
  EXPECT_NEAR(scalesAt(1.0).edge / scalesAt(0.1).edge, 10.0, 1e-3);
  EXPECT_NEAR(scalesAt(1.0).plane / scalesAt(0.1).plane, 10.0, 1e-3);
  EXPECT_DOUBLE_EQ(scalesAt(0.0).edge, kSmallestKernelScale);
  EXPECT_DOUBLE_EQ(scalesAt(0.0).plane, kSmallestKernelScale);
}

TEST_F(NormalEquationsTest, KernelScaleIsThreeStandardDeviationsByTheMedian)
{
  Correspondences correspondences;
  for (const double residual : {0.9, 0.01, 0.02, -0.8, 0.1, 0.7, -0.03}) {
    Correspondence c;
    c.factor = {FeatureKind::plane, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
    c.point = Eigen::Vector3d(3.0, 4.0, residual);
    c.weight = 1.0;
    correspondences.planes.push_back(c);
  }
  EXPECT_NEAR(adaptKernelScales(correspondences).plane, 3.0 * 1.4826 * 0.1, 1e-9);
}

TEST_F(NormalEquationsTest, CovarianceIsTheInverseInformationTimesTheVariance)
{
  parameters_.kernel = RobustKernel::none;
  const NormalEquations equations = equationsAt(trajectory_);
  const InformationAnalysis analysis(equations, 1e-4);
  const Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>(equations.information).inverse();
  const double variance = featureVariance(equations);
  const Eigen::Matrix<double, 6, 6> expected = variance * inverse;
  EXPECT_LT((analysis.covariance(variance) - expected).norm(), 1e-9 * expected.norm());
  EXPECT_NEAR(variance / (equations.residualVariance() * equations.given_weight / equations.count()), 7.0, 1e-9);
  EXPECT_TRUE(analysis.weakDirections(1e-4).empty());
}

}  // namespace
}  // namespace pcl_floam::test
