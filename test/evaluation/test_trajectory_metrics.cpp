#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace pcl_floam {
namespace {

using test::kPi;

using test::randomPath;
using test::randomTwist;

/// \p poses poses on a straight line, \p spacing m apart, turned about z by \p turn rad per pose as they go.
std::vector<SE3> straightPath(std::size_t poses, double spacing, double turn = 0.0)
{
  std::vector<SE3> path(poses);
  for (std::size_t i = 0; i < poses; ++i) {
    const auto n = static_cast<double>(i);
    path[i] = SE3(expSO3(Eigen::Vector3d(0.0, 0.0, turn * n)), Eigen::Vector3d(spacing * n, 0.0, 0.0));
  }
  return path;
}

std::vector<SE3> moved(const SE3& motion, std::vector<SE3> path)
{
  for (SE3& pose : path) {
    pose = motion * pose;
  }
  return path;
}

/// A path and an estimate of it that drifts.
struct DriftingPair : public ::testing::Test {
  DriftingPair()
  {
    std::mt19937 random(3);
    truth = randomPath(random, 900);
    estimate.resize(truth.size());
    for (std::size_t i = 1; i < truth.size(); ++i) {
      const SE3 step = truth[i - 1].inverse() * truth[i];
      estimate[i] = estimate[i - 1] * step * exp(randomTwist(random, 0.02, 0.002));
    }
    motion = exp(randomTwist(random, 50.0, 2.0));
  }
  std::vector<SE3> truth;
  std::vector<SE3> estimate;
  SE3 motion;
};

/// The development kit's procedure, written out: every pose is compared as a candidate for the end.
KittiMetric definition(const std::vector<SE3>& estimate, const std::vector<SE3>& truth)
{
  KittiMetric sum;
  for (std::size_t first = 0; first < truth.size(); first += 10) {
    for (double length = 100.0; length <= 800.0; length += 100.0) {
      double distance = 0.0;
      for (std::size_t last = first + 1; last < truth.size(); ++last) {
        distance += (truth[last].translation - truth[last - 1].translation).norm();
        if (distance > length) {
          const Eigen::Matrix4d true_motion = truth[first].matrix().inverse() * truth[last].matrix();
          const Eigen::Matrix4d estimated = estimate[first].matrix().inverse() * estimate[last].matrix();
          const Eigen::Matrix4d error = estimated.inverse() * true_motion;
          const double cosine = 0.5 * (error(0, 0) + error(1, 1) + error(2, 2) - 1.0);
          sum.translation += error.topRightCorner<3, 1>().norm() / length;
          sum.rotation += std::acos(std::max(std::min(cosine, 1.0), -1.0)) / length;
          ++sum.segments;
          break;
        }
      }
    }
  }
  const double scale = 100.0 / static_cast<double>(sum.segments);
  sum.translation *= scale;
  sum.rotation *= scale * 180.0 / kPi;
  return sum;
}

TEST_F(DriftingPair, KittiMetricIsTheDevelopmentKits)
{
  const KittiMetric expected = definition(estimate, truth);
  const KittiMetric metric = kittiMetric(estimate, truth);
  ASSERT_GT(expected.segments, 100U);
  EXPECT_EQ(metric.segments, expected.segments);
  EXPECT_NEAR(metric.translation, expected.translation, 1e-9);
  EXPECT_NEAR(metric.rotation, expected.rotation, 1e-6);  // acos loses digits near zero
  EXPECT_TRUE(metric.standard_lengths);
}

TEST_F(DriftingPair, KittiMetricIsTheMeanOfItsLengths)
{
  const KittiMetric metric = kittiMetric(estimate, truth);
  double translation = 0.0;
  std::size_t segments = 0;
  for (const SegmentErrors& errors : metric.lengths) {
    translation += errors.translation * static_cast<double>(errors.segments);
    segments += errors.segments;
  }
  EXPECT_EQ(segments, metric.segments);
  EXPECT_NEAR(translation / static_cast<double>(segments), metric.translation, 1e-9);
}

TEST_F(DriftingPair, NothingDependsOnTheWorldFrameOfTheEstimate)
{
  const std::vector<SE3> elsewhere = moved(motion, estimate);
  EXPECT_NEAR(kittiMetric(elsewhere, truth).translation, kittiMetric(estimate, truth).translation, 1e-8);
  EXPECT_NEAR(absoluteTrajectoryError(elsewhere, truth).rms, absoluteTrajectoryError(estimate, truth).rms, 1e-8);
  EXPECT_NEAR(absoluteTrajectoryError(elsewhere, truth, false).rms, absoluteTrajectoryError(estimate, truth, false).rms,
              1e-8);
  EXPECT_NEAR(relativePoseError(elsewhere, truth).translation.rms, relativePoseError(estimate, truth).translation.rms,
              1e-8);
}

TEST_F(DriftingPair, APerfectEstimateHasNoError)
{
  const std::vector<SE3> perfect = moved(motion, truth);
  EXPECT_NEAR(kittiMetric(perfect, truth).translation, 0.0, 1e-9);
  EXPECT_NEAR(kittiMetric(perfect, truth).rotation, 0.0, 1e-9);
  EXPECT_NEAR(absoluteTrajectoryError(perfect, truth).max, 0.0, 1e-9);
  EXPECT_NEAR(absoluteTrajectoryError(perfect, truth, false).max, 0.0, 1e-9);
  EXPECT_NEAR(relativePoseError(perfect, truth).rotation.max, 0.0, 1e-9);
}

TEST_F(DriftingPair, NoOtherAlignmentIsBetter)
{
  const SE3 best = alignTrajectories(estimate, truth);
  const auto squaredError = [this](const SE3& truth_T_estimate) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      sum += (truth_T_estimate * estimate[i].translation - truth[i].translation).squaredNorm();
    }
    return sum;
  };
  const double rms = absoluteTrajectoryError(estimate, truth).rms;
  EXPECT_NEAR(squaredError(best), rms * rms * static_cast<double>(truth.size()), 1e-6);
  for (int axis = 0; axis < 6; ++axis) {
    for (const double step : {-1e-4, 1e-4}) {
      Vector6 twist = Vector6::Zero();
      twist[axis] = step;
      EXPECT_GT(squaredError(exp(twist) * best), squaredError(best)) << "axis " << axis;
    }
  }
}

TEST_F(DriftingPair, AlignmentFindsTheMotionBetweenTheTwo)
{
  const SE3 found = alignTrajectories(moved(motion, truth), truth);
  const SE3 left = found * motion;
  EXPECT_NEAR(left.translation.norm(), 0.0, 1e-9);
  EXPECT_NEAR(rotationAngle(left.rotation), 0.0, 1e-9);
}

TEST(KittiMetric, EndsAtTheFirstPoseBeyondTheLengthAndDividesByTheLength)
{
  // 1 % too long; the sub-sequence of 100 m ends at 101 m, as the development kit has it.
  const KittiMetric metric = kittiMetric(straightPath(150, 1.01), straightPath(150, 1.0));
  ASSERT_EQ(metric.lengths.size(), 1U);
  EXPECT_EQ(metric.segments, 5U);  // from poses 0, 10, 20, 30, 40
  EXPECT_NEAR(metric.translation, 1.01, 1e-9);
  EXPECT_NEAR(metric.rotation, 0.0, 1e-9);
}

TEST(KittiMetric, ReportsRotationInDegreesPer100Meters)
{
  constexpr double kDegreesPerPose = 0.01;
  const KittiMetric metric = kittiMetric(straightPath(150, 1.0, kDegreesPerPose * kPi / 180.0), straightPath(150, 1.0));
  EXPECT_NEAR(metric.rotation, 101.0 * kDegreesPerPose, 1e-9);
}

TEST(KittiMetric, HasNoSegmentsOnAPathShorterThanAllLengths)
{
  const KittiMetric metric = kittiMetric(straightPath(50, 1.0), straightPath(50, 1.0));
  EXPECT_EQ(metric.segments, 0U);
  EXPECT_TRUE(metric.lengths.empty());
  EXPECT_EQ(metric.translation, 0.0);
}

TEST(KittiMetric, SaysWhenItsLengthsAreNotKittis)
{
  EXPECT_TRUE(fittingKittiMetric(straightPath(250, 1.0), straightPath(250, 1.0)).standard_lengths);
  const KittiMetric short_run = fittingKittiMetric(straightPath(108, 1.01), straightPath(108, 1.0));
  EXPECT_FALSE(short_run.standard_lengths);
  EXPECT_EQ(short_run.step, 1U);
  EXPECT_EQ(short_run.lengths.size(), 8U);
  EXPECT_DOUBLE_EQ(short_run.lengths.front().length, 10.0);
  EXPECT_DOUBLE_EQ(short_run.lengths.back().length, 80.0);
}

TEST(LengthsFor, AlwaysFitIntoAShortPath)
{
  for (double path = 0.013; path < 200.0; path *= 1.37) {
    const std::vector<double> lengths = lengthsFor(path);
    ASSERT_EQ(lengths.size(), 8U);
    EXPECT_LE(lengths.back(), 0.8 * path * (1.0 + 1e-12)) << path;
    EXPECT_GT(lengths.front(), 0.03 * path) << path;
  }
  EXPECT_EQ(lengthsFor(200.0), kittiLengths());
  EXPECT_EQ(lengthsFor(5000.0), kittiLengths());
  EXPECT_EQ(lengthsFor(0.0), kittiLengths());
}

TEST(AbsoluteTrajectoryError, IsTheDistanceAfterAlignment)
{
  // A zigzag of 1 cm to either side cannot be aligned away.
  std::vector<SE3> truth = straightPath(100, 1.0);
  std::vector<SE3> estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].translation.z() += i % 2 == 0 ? 0.01 : -0.01;
  }
  const ErrorStatistics errors = absoluteTrajectoryError(estimate, truth);
  EXPECT_EQ(errors.count, 100U);
  EXPECT_NEAR(errors.rms, 0.01, 1e-4);
  EXPECT_NEAR(errors.median, 0.01, 1e-4);
}

TEST(AbsoluteTrajectoryError, IsFiniteWithoutMotion)
{
  const std::vector<SE3> still(10);
  EXPECT_NEAR(absoluteTrajectoryError(still, still).max, 0.0, 1e-12);
  EXPECT_NEAR(absoluteTrajectoryError(straightPath(5, 1.0), straightPath(5, 1.0)).max, 0.0, 1e-12);
  EXPECT_EQ(absoluteTrajectoryError({}, {}).count, 0U);
}

TEST(RelativePoseError, MeasuresTheErrorOfEachStep)
{
  const RelativePoseError errors =
      relativePoseError(straightPath(20, 1.1, 0.5 * kPi / 180.0), straightPath(20, 1.0), 1);
  EXPECT_EQ(errors.translation.count, 19U);
  EXPECT_NEAR(errors.rotation.mean, 0.5, 1e-9);
  const RelativePoseError longer = relativePoseError(straightPath(20, 1.1), straightPath(20, 1.0), 5);
  EXPECT_EQ(longer.translation.count, 15U);
  EXPECT_NEAR(longer.translation.rms, 0.5, 1e-9);
}

TEST(TrajectoryMetrics, StatisticsAreOfTheErrors)
{
  // Errors of 0, 1, 2, 9 m against the first pose.
  std::vector<SE3> truth(4);
  std::vector<SE3> estimate(4);
  estimate[1].translation.x() = 1.0;
  estimate[2].translation.y() = 2.0;
  estimate[3].translation.z() = 9.0;
  const ErrorStatistics errors = absoluteTrajectoryError(estimate, truth, false);
  EXPECT_DOUBLE_EQ(errors.mean, 3.0);
  EXPECT_DOUBLE_EQ(errors.median, 1.5);
  EXPECT_DOUBLE_EQ(errors.max, 9.0);
  EXPECT_DOUBLE_EQ(errors.rms, std::sqrt((1.0 + 4.0 + 81.0) / 4.0));
}

TEST(TrajectoryMetrics, RefuseTrajectoriesOfDifferentSizeAndMeaninglessSteps)
{
  const std::vector<SE3> two(2);
  const std::vector<SE3> three(3);
  EXPECT_THROW((void)kittiMetric(two, three), std::invalid_argument);
  EXPECT_THROW((void)absoluteTrajectoryError(two, three), std::invalid_argument);
  EXPECT_THROW((void)relativePoseError(two, three), std::invalid_argument);
  EXPECT_THROW((void)alignTrajectories(two, three), std::invalid_argument);
  EXPECT_THROW((void)kittiMetric(two, two, {100.0}, 0), std::invalid_argument);
  EXPECT_THROW((void)kittiMetric(two, two, {0.0}), std::invalid_argument);
  EXPECT_THROW((void)relativePoseError(two, two, 0), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam
