// The pose is found again after a time without scans.
#include "odometry/best_fit.h"
#include "odometry/relocalization.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/map/keyframe_voxel_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

RegistrationReport fit(int linked, double residual)
{
  RegistrationReport report;
  report.termination = Termination::converged;
  report.plane_correspondences = linked;
  report.residual_rms = residual;
  return report;
}

TEST(BestFit, HasTheLeastResidualsOfThoseThatLinkMost)
{
  EXPECT_EQ(bestFit({fit(100, 0.1), fit(95, 0.02), fit(50, 0.01)}, 0.5), 1U);
  EXPECT_EQ(bestFit({fit(10, 0.01), fit(95, 0.2), fit(100, 0.3)}, 0.5), 1U);
}

TEST(BestFit, IsTheFirstUnlessAnotherIsClearlyBetter)
{
  EXPECT_EQ(bestFit({fit(90, 0.1), fit(100, 0.06)}, 0.5), 0U);
  EXPECT_EQ(bestFit({fit(90, 0.1), fit(100, 0.04)}, 0.5), 1U);
  EXPECT_EQ(bestFit({fit(90, 0.1), fit(100, 0.08), fit(100, 0.07)}, 0.9), 2U);
}

TEST(BestFit, IsTheFirstIfNoneHasConverged)
{
  EXPECT_EQ(bestFit({RegistrationReport(), RegistrationReport()}, 0.5), 0U);
  EXPECT_EQ(bestFit({RegistrationReport(), fit(20, 0.3)}, 0.5), 1U);
}

/// With noise of 1 cm: exact scans of rooms that look the same differ by nothing but rounding.
FeatureSet noisyScan(const Room& room, const SE3& truth)
{
  FeatureSet scan = featuresOf(toCloud(sweepRoom(room, Lidar(), truth)));
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  for (std::vector<Feature>* features : {&scan.edges, &scan.planes}) {
    for (Feature& feature : *features) {
      feature.x += noise(random);
      feature.y += noise(random);
      feature.z += noise(random);
    }
  }
  return scan;
}

/// The pose of a scan from \p truth in a room, found from a prediction.
SE3 relocalizeIn(const Room& room, const SE3& truth, const SE3& predicted, const SE3& tracked)
{
  KeyframeVoxelMap map;
  map.insert(featuresOf(toCloud(sweepRoom(room, Lidar(), SE3()))), SE3());
  map.insert(featuresOf(toCloud(sweepRoom(room, Lidar(), truth))), truth);
  const FeatureTarget target{&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)};
  RegistrationRun run;
  run.guess = predicted;
  return relocalize(noisyScan(room, truth), target, run, RegistrationParameters(), tracked);
}

SE3 turned(double degrees)
{
  return exp((Vector6() << 0.3, -0.2, 0.05, 0.02, -0.03, degrees * M_PI / 180.0).finished());
}

TEST(Relocalization, FindsASensorThatHasTurnedByAnything)
{
  for (const double degrees : {-160.0, -95.0, -40.0, 0.0, 70.0, 130.0, 175.0}) {
    const SE3 predicted = turned(100.0) * exp((Vector6() << 0.6, 0.2, -0.3, 0.3, 0.0, 0.4).finished());
    const SE3 error = turned(degrees).inverse() * relocalizeIn(Room(), turned(degrees), predicted, SE3());
    EXPECT_LT(error.translation.norm(), 0.1) << degrees;
    EXPECT_LT(rotationAngle(error.rotation), 0.05) << degrees;
  }
}

TEST(Relocalization, KeepsToThePredictionWhereTheRoomLooksTheSame)
{
  Room square;
  square.walls = {{-5.0, -5.0, -1.5}, {5.0, 5.0, 2.0}};
  square.furniture.clear();
  for (const double degrees : {0.0, 90.0, 180.0, -90.0}) {
    const SE3 truth = exp(Vector6(degrees * M_PI / 180.0 * Vector6::Unit(5)));
    const SE3 error = truth.inverse() * relocalizeIn(square, truth, truth, SE3());
    EXPECT_LT(rotationAngle(error.rotation), 0.05) << degrees;
  }
}

TEST(Relocalization, LeavesThePredictionWhereNothingFits)
{
  KeyframeVoxelMap map;
  const FeatureTarget target{&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)};
  RegistrationRun run;
  run.guess = turned(10.0);
  const FeatureSet scan = featuresOf(toCloud(sweepRoom(Room(), Lidar(), SE3())));
  const SE3 found = relocalize(scan, target, run, RegistrationParameters(), SE3());
  EXPECT_EQ(found.translation, run.guess.translation);
  EXPECT_EQ(found.rotation, run.guess.rotation);
}

}  // namespace
}  // namespace pcl_floam::test
