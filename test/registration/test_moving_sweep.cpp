// The pose estimation of a sweep during which the sensor moves.
#include "registration/feature_registration_test.h"

#include <pcl_floam/filters/core/sweep_motion.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

/// The sweep of a lidar that moves by \p twist, with the given pose at its middle.
class MovingSweepTest : public FeatureRegistrationTest {
protected:
  void SetUp() override
  {
    mapRoom();
    const auto path = [&](double time) { return truth_ * exp((time - 0.5) * twist_); };
    scan_ = featuresOf(toCloud(sweepRoom(room_, lidar_, path)));
    run_.guess = guess_;
    run_.sweep.reference = 0.5;
  }

  RegistrationReport runWith(const SweepModel& sweep)
  {
    run_.sweep = sweep;
    run_.sweep.reference = 0.5;
    return registerFeatures(scan_, {&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)}, run_,
                            parameters_);
  }

  void expectTruth(const RegistrationReport& report)
  {
    EXPECT_EQ(report.termination, Termination::converged);
    EXPECT_LT(distance(report.target_T_source, truth_), 0.01);
    EXPECT_LT(angle(report.target_T_source, truth_), 1e-3);
    EXPECT_LT((report.sweep_twist - twist_).head<3>().norm(), 0.02);
    EXPECT_LT((report.sweep_twist - twist_).tail<3>().norm(), 3e-3);
  }

  Vector6 twist_ = (Vector6() << 0.3, -0.2, 0.05, 0.02, 0.03, 0.2).finished();
  RegistrationRun run_;
};

TEST_F(MovingSweepTest, KnownMotionIsCompensated)
{
  SweepModel sweep;
  sweep.twist = twist_;
  expectTruth(runWith(sweep));
  const RegistrationReport distorted = runWith(SweepModel());
  EXPECT_GT(distorted.residual_rms, 2.0 * runWith(sweep).residual_rms);
}

TEST_F(MovingSweepTest, MotionThatFollowsThePoseIsFound)
{
  SweepModel sweep;
  sweep.follows_pose = true;
  sweep.held_pose = truth_ * exp(-1.25 * twist_);
  sweep.sweep_per_motion = 0.8;
  for (const SolverKind solver : {SolverKind::gauss_newton, SolverKind::ceres}) {
    parameters_.solver = solver;
    expectTruth(runWith(sweep));
  }
}

TEST_F(MovingSweepTest, MotionThatFollowsThePoseFarFromTheOrigin)
{
  const Eigen::Vector3d far(1e6, -5e5, 1e3);
  const SE3 to_far(Eigen::Matrix3d::Identity(), far);
  SweepModel sweep;
  sweep.follows_pose = true;
  sweep.held_pose = truth_ * exp(-1.25 * twist_);
  sweep.sweep_per_motion = 0.8;
  const RegistrationReport near = runWith(sweep);
  mapRoom(far);
  run_.guess = to_far * guess_;
  sweep.held_pose = to_far * sweep.held_pose;
  const RegistrationReport there = runWith(sweep);
  EXPECT_LT(distance(to_far * near.target_T_source, there.target_T_source), 1e-3);
  EXPECT_LT((near.sweep_twist - there.sweep_twist).norm(), 1e-3);
}

}  // namespace
}  // namespace pcl_floam::test
