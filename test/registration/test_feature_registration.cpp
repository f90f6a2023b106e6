// The pose estimation in a furnished room.
#include "registration/feature_registration_test.h"
#include "support/random_motion.h"

#include <pcl_floam/filters/core/sweep_motion.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/core/feature_registration.h>

#include <gtest/gtest.h>

#include <limits>

namespace pcl_floam::test {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

bool sameBits(const SE3& a, const SE3& b)
{
  return a.rotation == b.rotation && a.translation == b.translation;
}

/// The source's origin is at a place, to 0.1 mm.
class Place : public PoseFactor {
public:
  explicit Place(const Eigen::Vector3d& place) : place_(place) {}

  void addTo(const SE3& target_T_source, PoseEquations& equations) const override
  {
    for (int axis = 0; axis < 3; ++axis) {
      Vector6 along = Vector6::Zero();
      along[axis] = 1.0;
      equations.add(target_T_source.translation[axis] - place_[axis], along, 1e-8);
    }
  }

private:
  Eigen::Vector3d place_;
};

TEST_F(FeatureRegistrationTest, AFactorThatIsSureDecidesByBothSolvers)
{
  mapRoom();
  const Eigen::Vector3d place = truth_.translation + Eigen::Vector3d(0.02, -0.01, 0.015);
  factors_ = {std::make_shared<Place>(place)};
  for (const SolverKind solver : {SolverKind::gauss_newton, SolverKind::ceres}) {
    parameters_.solver = solver;
    const RegistrationReport report = run(guess_);
    EXPECT_TRUE(report.hasConverged());
    EXPECT_LT((report.target_T_source.translation - place).norm(), 1e-3) << toString(solver);
    EXPECT_LT(angle(report.target_T_source, truth_), 5e-3) << toString(solver);
  }
}

TEST_F(FeatureRegistrationTest, AFactorMovesNothingThatIsLocked)
{
  mapRoom();
  factors_ = {std::make_shared<Place>(truth_.translation + Eigen::Vector3d(0.0, 0.0, 0.5))};
  parameters_.locked = kPlanarMotion;
  for (const SolverKind solver : {SolverKind::gauss_newton, SolverKind::ceres}) {
    parameters_.solver = solver;
    EXPECT_NEAR(run(guess_).target_T_source.translation.z(), guess_.translation.z(), 1e-6) << toString(solver);
  }
}

TEST_F(FeatureRegistrationTest, RecoversAKnownPose)
{
  for (const SearchMethod search : {SearchMethod::voxel, SearchMethod::kdtree}) {
    mapRoom(Eigen::Vector3d::Zero(), search);
    const RegistrationReport report = run(guess_);
    EXPECT_EQ(report.termination, Termination::converged);
    EXPECT_LT(distance(report.target_T_source, truth_), 0.01) << toString(search);
    EXPECT_LT(angle(report.target_T_source, truth_), 1e-3) << toString(search);
    EXPECT_TRUE(report.weak_directions.empty());
    EXPECT_GT(report.edge_inliers, 20);
    EXPECT_GT(report.plane_inliers, 500);
    EXPECT_LT(report.residual_rms, 0.05);
  }
}

TEST_F(FeatureRegistrationTest, EverySchemeAndKernelRecoversIt)
{
  mapRoom();
  for (const WeightScheme scheme : {WeightScheme::uniform, WeightScheme::inverted, WeightScheme::printed}) {
    for (const RobustKernel kernel : {RobustKernel::huber, RobustKernel::cauchy, RobustKernel::geman_mcclure}) {
      parameters_.weights = scheme;
      parameters_.kernel = kernel;
      EXPECT_LT(distance(run(guess_).target_T_source, truth_), 0.02) << toString(scheme) << ' ' << toString(kernel);
    }
  }
}

TEST_F(FeatureRegistrationTest, SolversAgree)
{
  mapRoom();
  precision_ = 1e-6;
  iterations_ = 100;
  const RegistrationReport gauss_newton = run(guess_);
  parameters_.solver = SolverKind::ceres;
  const RegistrationReport ceres = run(guess_);
  // On their way there they search at different places, and keep what they found over a small last bit of it.
  EXPECT_LT(distance(gauss_newton.target_T_source, ceres.target_T_source), 2e-4);
  EXPECT_LT(angle(gauss_newton.target_T_source, ceres.target_T_source), 1e-4);
  EXPECT_FALSE(sameBits(gauss_newton.target_T_source, ceres.target_T_source));
}

TEST_F(FeatureRegistrationTest, LockedDegreesOfFreedomKeepTheGuess)
{
  mapRoom();
  parameters_.locked = kPlanarMotion;
  const SE3 planar = exp((Vector6() << 0.2, -0.1, 0.0, 0.0, 0.0, -0.03).finished());
  const SE3 wrong_height(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, 0.05));
  for (const SolverKind solver : {SolverKind::gauss_newton, SolverKind::ceres}) {
    parameters_.solver = solver;
    EXPECT_LT(distance(run(planar * truth_).target_T_source, truth_), 0.01) << toString(solver);

    const RegistrationReport report = run(wrong_height * planar * truth_);
    const SE3 error = report.target_T_source * truth_.inverse();
    EXPECT_TRUE(report.hasConverged());
    EXPECT_NEAR(report.target_T_source.translation.z(), truth_.translation.z() + 0.05, 1e-12) << toString(solver);
    EXPECT_LT((error.rotation.col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-12) << toString(solver);
    EXPECT_LT(error.translation.head<2>().norm(), 0.02) << toString(solver);
    EXPECT_TRUE(report.weak_directions.empty());
    EXPECT_EQ(report.covariance(2, 2), 0.0);
    EXPECT_GT(report.covariance(0, 0), 0.0);
  }
}

TEST_F(FeatureRegistrationTest, TooFewCorrespondencesInTheOnlyIterationAreNoSuccess)
{
  mapRoom();
  iterations_ = 1;
  // Enough features that the first iteration looks at a part of them only.
  ASSERT_GE(scan_.edges.size() + scan_.planes.size(), 1000U);
  const SE3 guess(Eigen::Matrix3d::Identity(), Eigen::Vector3d(200.0, 0.0, 0.0));
  const RegistrationReport report = run(guess);
  EXPECT_EQ(report.termination, Termination::too_few_correspondences);
  EXPECT_FALSE(report.hasConverged());
  EXPECT_TRUE(sameBits(report.target_T_source, guess));
}

TEST_F(FeatureRegistrationTest, SameBitsForEveryNumberOfThreads)
{
  mapRoom();
  for (const SolverKind solver : {SolverKind::gauss_newton, SolverKind::ceres}) {
    parameters_.solver = solver;
    const RegistrationReport one = run(guess_, 1);
    for (const int threads : {2, 3}) {
      const RegistrationReport many = run(guess_, threads);
      EXPECT_TRUE(sameBits(one.target_T_source, many.target_T_source)) << threads;
      EXPECT_EQ(one.covariance, many.covariance);
      EXPECT_EQ(one.iterations, many.iterations);
    }
  }
}

TEST_F(FeatureRegistrationTest, FarFromTheOriginAsNearIt)
{
  mapRoom();
  const RegistrationReport near = run(guess_);
  const Eigen::Vector3d far(1.2e6, -2.4e6, 6e3);  // whole voxels away: the same map, but for rounding
  mapRoom(far);
  const RegistrationReport there = run(SE3(guess_.rotation, guess_.translation + far));
  EXPECT_TRUE(there.hasConverged());
  EXPECT_LT((there.target_T_source.translation - far - near.target_T_source.translation).norm(), 1e-3);
  EXPECT_LT(angle(there.target_T_source, near.target_T_source), 1e-4);
}

TEST_F(FeatureRegistrationTest, AWideSearchBringsInAFarGuess)
{
  mapRoom();
  RegistrationRun run;
  run.guess = SE3(truth_.rotation, truth_.translation + Eigen::Vector3d(1.5, -1.0, 0.0));
  run.guess_uncertainty = 3.0;
  const auto report =
      registerFeatures(scan_, {&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)}, run, parameters_);
  EXPECT_LT(distance(report.target_T_source, truth_), 0.01);
}

TEST_F(FeatureRegistrationTest, IterationLimitIsKept)
{
  mapRoom();
  iterations_ = 1;
  const RegistrationReport report = run(guess_);
  EXPECT_EQ(report.termination, Termination::iteration_limit);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_LT(distance(report.target_T_source, truth_), distance(guess_, truth_));
}

TEST_F(FeatureRegistrationTest, TooFewFeaturesAreReported)
{
  mapRoom();
  scan_.edges.resize(5);
  scan_.planes.resize(5);
  const RegistrationReport report = run(guess_);
  EXPECT_EQ(report.termination, Termination::too_few_features);
  EXPECT_FALSE(report.hasConverged());
  EXPECT_TRUE(sameBits(report.target_T_source, guess_));
  scan_.clear();
  EXPECT_EQ(run(guess_).termination, Termination::too_few_features);
}

TEST_F(FeatureRegistrationTest, AnEmptyTargetIsReported)
{
  const RegistrationReport report = run(guess_);
  EXPECT_EQ(report.termination, Termination::empty_target);
  EXPECT_TRUE(sameBits(report.target_T_source, guess_));
}

TEST_F(FeatureRegistrationTest, AFarTargetIsReported)
{
  mapRoom(Eigen::Vector3d(500.0, 0.0, 0.0));
  const RegistrationReport report = run(guess_);
  EXPECT_EQ(report.termination, Termination::too_few_correspondences);
  EXPECT_TRUE(sameBits(report.target_T_source, guess_));
}

TEST_F(FeatureRegistrationTest, NothingThatIsNotFiniteComesOut)
{
  mapRoom();
  SE3 guess = guess_;
  guess.translation.x() = kNoNumber;
  EXPECT_EQ(run(guess).termination, Termination::invalid_input);
  EXPECT_TRUE(run(guess).target_T_source.isFinite());
  guess = guess_;
  guess.rotation(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(run(guess).termination, Termination::invalid_input);

  scan_.planes[3].x = std::numeric_limits<float>::quiet_NaN();
  scan_.edges[3].z = std::numeric_limits<float>::infinity();
  const RegistrationReport report = run(guess_);
  EXPECT_TRUE(report.hasConverged());
  EXPECT_LT(distance(report.target_T_source, truth_), 0.01);
  EXPECT_TRUE(report.covariance.allFinite());
}

TEST_F(FeatureRegistrationTest, OneSinglePlaneKeepsTheGuessAlongIt)
{
  std::mt19937 random(1);
  std::vector<Eigen::Vector3d> wall;
  for (int i = 0; i < 20000; ++i) {
    wall.emplace_back(uniform(random, 20.0), uniform(random, 20.0), 0.0);
  }
  map_.insertPoints(FeatureKind::plane, wall);
  scan_.clear();
  for (int i = 0; i < 500; ++i) {
    Feature feature;
    feature.x = static_cast<float>(uniform(random, 10.0));
    feature.y = static_cast<float>(uniform(random, 10.0));
    scan_.planes.push_back(feature);
  }
  const SE3 guess(expSO3(Eigen::Vector3d(0.01, -0.02, 0.3)), Eigen::Vector3d(1.0, 2.0, 0.3));
  const RegistrationReport report = run(guess);
  EXPECT_TRUE(report.hasConverged());
  EXPECT_EQ(report.weak_directions.size(), 3U);
  EXPECT_NEAR(report.target_T_source.translation.z(), 0.0, 1e-4);
  EXPECT_NEAR(report.target_T_source.rotation(2, 2), 1.0, 1e-6);
  EXPECT_NEAR(report.target_T_source.translation.x(), 1.0, 0.02);  // tilting back moves it a little
  EXPECT_NEAR(report.target_T_source.translation.y(), 2.0, 0.02);
  EXPECT_NEAR(std::atan2(report.target_T_source.rotation(1, 0), report.target_T_source.rotation(0, 0)), 0.3, 1e-3);
}

}  // namespace
}  // namespace pcl_floam::test
