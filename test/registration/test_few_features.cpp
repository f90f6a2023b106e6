// Corridors of which little is seen: a floor of few scan lines, few edges that tell of the way along.
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/feature_registration.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

void add(float x, float y, float z, std::vector<Feature>& features)
{
  Feature feature;
  feature.x = x;
  feature.y = y;
  feature.z = z;
  features.push_back(feature);
}

/// What a lidar with few lines sees of a smooth corridor: its walls, and two lines of the floor ahead and behind.
FeatureSet corridorWithFewLines(unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, 0.005F);
  std::uniform_real_distribution<float> shift(0.0F, 0.1F);
  FeatureSet features;
  for (float along = -6.0F; along < 6.0F; along += 0.2F) {
    for (float height = -0.5F; height < 1.0F; height += 0.25F) {
      for (const float side : {-1.1F, 1.1F}) {
        add(along + shift(random), side + noise(random), height + shift(random), features.planes);
      }
    }
  }
  for (const float line : {-4.1F, -3.4F, 3.4F, 4.1F}) {
    for (float across = -1.0F; across < 0.9F; across += 0.2F) {
      add(line + noise(random), across + shift(random), -0.9F + noise(random), features.planes);
    }
  }
  return features;
}

/// A smooth corridor, the frames of four doors, and a cart somewhere ahead.
FeatureSet corridorWithDoors(unsigned seed, float cart)
{
  FeatureSet features = corridorWithFewLines(seed);
  for (const float along : {-4.0F, -3.0F, 2.0F, 3.0F}) {
    for (float height = -0.6F; height < 0.7F; height += 0.2F) {
      add(along, along > 0.0F ? 1.1F : -1.1F, height, features.edges);
    }
  }
  for (const float across : {-0.2F, 0.2F}) {
    for (const float height : {-0.4F, 0.0F, 0.4F}) {
      add(cart, across, height, features.planes);
    }
  }
  return features;
}

/// Registers scans of a corridor in a map of one scan. The truth is no motion at all.
class FewFeatures : public testing::Test {
protected:
  FewFeatures() { run_.sparse_target = true; }

  /// \return the error of the registered position, m
  Eigen::Vector3d errorOf(const FeatureSet& scan)
  {
    const FeatureTarget target{&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)};
    report_ = registerFeatures(scan, target, run_, {});
    EXPECT_TRUE(report_.hasConverged());
    return report_.target_T_source.translation.cwiseAbs();
  }

  static constexpr unsigned kFirstSeed = 2;  // 1 is the map's
  static constexpr unsigned kEndSeed = 7;
  KeyframeVoxelMap map_;
  RegistrationRun run_;
  RegistrationReport report_;
};

TEST_F(FewFeatures, FloorsOfFewScanLinesHoldTheHeight)
{
  map_.insert(corridorWithFewLines(1), SE3());
  run_.guess.translation = Eigen::Vector3d(0.0, 0.0, 0.04);
  for (unsigned seed = kFirstSeed; seed < kEndSeed; ++seed) {
    run_.sparse_target = true;
    EXPECT_LT(errorOf(corridorWithFewLines(seed)).z(), 0.01);
    run_.sparse_target = false;  // the floor's lines make no planes
    EXPECT_GT(errorOf(corridorWithFewLines(seed)).z(), 0.03);
  }
}

TEST_F(FewFeatures, EdgesHoldThePoseOnceTheyAgreeThatItIsOff)
{
  map_.insert(corridorWithDoors(1, 5.0F), SE3());
  run_.guess.translation = Eigen::Vector3d(0.3, 0.0, 0.0);  // where the cart, which has moved, would be as before
  for (unsigned seed = kFirstSeed; seed < kEndSeed; ++seed) {
    FeatureSet scan = corridorWithDoors(seed, 4.7F);
    scan.planes.resize(scan.planes.size() - 2);  // some of the cart: all of it would outweigh the doors
    run_.guess_uncertainty = 0.4;
    EXPECT_LT(errorOf(scan).x(), 0.02);
    EXPECT_TRUE(report_.weak_directions.empty());
    run_.guess_uncertainty = 0.0;  // the guess is said to be good: 30 cm off, the edges must be wrong
    EXPECT_GT(errorOf(scan).x(), 0.2);
    EXPECT_TRUE(report_.weak_directions.empty());
  }
}

TEST_F(FewFeatures, EdgesThatAreWrongDoNotDrawThePoseAway)
{
  map_.insert(corridorWithDoors(1, 5.0F), SE3());
  run_.guess_uncertainty = 0.4;
  for (unsigned seed = kFirstSeed; seed < kEndSeed; ++seed) {
    FeatureSet scan = corridorWithDoors(seed, 5.0F);
    for (Feature& edge : scan.edges) {
      edge.x += edge.x > -3.5F ? 0.3F : 0.0F;  // all doors but one are open by now
    }
    EXPECT_LT(errorOf(scan).x(), 0.1);
    EXPECT_TRUE(report_.weak_directions.empty());
  }
}

}  // namespace
}  // namespace pcl_floam::test
