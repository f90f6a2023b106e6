// A scan in the map when a part of the view tells something else than the rest.
#include "odometry/scan_registration.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/map/keyframe_voxel_map.h>

#include <gtest/gtest.h>

#include <random>

namespace pcl_floam::test {
namespace {

class ScanRegistrationTest : public testing::Test {
protected:
  void SetUp() override { map_.insert(featuresOf(toCloud(sweepRoom(Room(), Lidar(), SE3()))), SE3()); }

  RegistrationReport registerScan() { return scan_registration_.registerScan(scan_, target(), run(), parameters_); }

  /// With all of its features.
  RegistrationReport registerAll() { return registerFeatures(scan_, target(), run(), parameters_); }

  FeatureTarget target() { return {&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)}; }

  RegistrationRun run()
  {
    RegistrationRun run;
    run.guess = truth_ * exp((Vector6() << 0.1, -0.1, 0.05, 0.01, 0.01, -0.02).finished());
    return run;
  }

  double error(const RegistrationReport& report) { return log(truth_.inverse() * report.target_T_source).norm(); }

  /// Behind a wall, not in the map, and so dense that nearly all of the features that are registered are its own.
  void addCrowd()
  {
    constexpr int kFeatures = 300000;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> within(-0.5F, 0.5F);
    for (std::vector<Feature>* features : {&scan_.edges, &scan_.planes}) {
      for (int i = 0; i < kFeatures; ++i) {
        Feature feature;
        feature.x = 60.0F + within(random);
        feature.y = within(random);
        feature.z = within(random);
        features->push_back(feature);
      }
    }
  }

  KeyframeVoxelMap map_;
  SE3 truth_ = exp((Vector6() << 0.4, -0.3, 0.1, 0.02, -0.03, 0.15).finished());
  FeatureSet scan_ = featuresOf(toCloud(sweepRoom(Room(), Lidar(), truth_)));
  RegistrationParameters parameters_;
  ScanRegistration scan_registration_;
};

TEST_F(ScanRegistrationTest, AllFeaturesGiveThePoseAsLongAsTheSpreadOnesAgree)
{
  for (int i = 0; i < 30; ++i) {
    const RegistrationReport report = registerScan();
    EXPECT_TRUE(report.hasConverged());
    EXPECT_EQ(report.target_T_source.translation, registerAll().target_T_source.translation);
    EXPECT_FALSE(scan_registration_.usedSpreadFeatures());
  }
}

TEST_F(ScanRegistrationTest, SuspectedAtFirstTheSpreadOnesGiveIt)
{
  scan_registration_.suspectCrowding();
  for (int i = 0; i < 3; ++i) {
    const RegistrationReport report = registerScan();
    EXPECT_TRUE(scan_registration_.usedSpreadFeatures());
    EXPECT_TRUE(report.hasConverged());
    EXPECT_LT(error(report), 0.02);
    EXPECT_NE(report.target_T_source.translation, registerAll().target_T_source.translation);
  }
}

TEST_F(ScanRegistrationTest, SuspicionEndsWhereBothAgree)
{
  const FeatureSet exact = scan_;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  scan_registration_.suspectCrowding();
  int scans = 0;
  do {
    scan_ = exact;
    for (std::vector<Feature>* features : {&scan_.edges, &scan_.planes}) {
      for (Feature& feature : *features) {
        feature.x += noise(random);
        feature.y += noise(random);
        feature.z += noise(random);
      }
    }
    EXPECT_TRUE(registerScan().hasConverged());
  } while (++scans < 100 && scan_registration_.usedSpreadFeatures());
  EXPECT_GT(scans, 10);
  EXPECT_LT(scans, 30);
  EXPECT_EQ(registerScan().target_T_source.translation, registerAll().target_T_source.translation);
}

TEST_F(ScanRegistrationTest, FewFeaturesAreAllTaken)
{
  for (std::vector<Feature>* features : {&scan_.edges, &scan_.planes}) {
    features->resize(features->size() * 300 / scan_.planes.size());
  }
  scan_registration_.suspectCrowding();
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(registerScan().hasConverged());
    EXPECT_FALSE(scan_registration_.usedSpreadFeatures());
  }
}

TEST_F(ScanRegistrationTest, SpreadFeaturesHelpWhereAllFail)
{
  addCrowd();
  EXPECT_EQ(registerAll().termination, Termination::too_few_correspondences);
  for (int i = 0; i < 3; ++i) {
    const RegistrationReport report = registerScan();
    EXPECT_TRUE(report.hasConverged());
    EXPECT_TRUE(scan_registration_.usedSpreadFeatures());
    EXPECT_LT(error(report), 0.02);
  }
}

TEST_F(ScanRegistrationTest, AllFeaturesHelpWhereTheSpreadOnesFail)
{
  parameters_.min_correspondences = 700;  // more than are spread
  scan_registration_.suspectCrowding();
  for (int i = 0; i < 6; ++i) {
    const RegistrationReport report = registerScan();
    EXPECT_TRUE(report.hasConverged());
    EXPECT_FALSE(scan_registration_.usedSpreadFeatures());
    EXPECT_LT(error(report), 0.02);
  }
}

}  // namespace
}  // namespace pcl_floam::test
