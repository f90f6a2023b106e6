// What the viewer shows and when, without a window.
#include "odometry_result.h"
#include "replay.h"
#include "support/temporary_folder.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <fstream>

namespace pcl_floam::viewer {
namespace {

TEST(Replay, RunsAtItsRateAndWaitsAtTheLastPose)
{
  Replay replay(10.0, 2);
  EXPECT_EQ(replay.current(), 0U);  // there is none yet
  replay.setSize(20);
  EXPECT_EQ(replay.current(), 2U);
  replay.advance(0.5);
  EXPECT_EQ(replay.current(), 7U);
  replay.advance(100.0);
  EXPECT_EQ(replay.current(), 19U);
  replay.setSize(30);
  EXPECT_EQ(replay.current(), 19U);
  replay.advance(0.2);
  EXPECT_EQ(replay.current(), 21U);
}

TEST(Replay, KeysPauseAndStep)
{
  Replay replay(10.0, 5);
  replay.setSize(10);
  EXPECT_TRUE(replay.press("space"));
  EXPECT_TRUE(replay.isPaused());
  replay.advance(10.0);
  EXPECT_EQ(replay.current(), 5U);
  replay.press("space");
  replay.advance(0.15);
  replay.press("Right");
  EXPECT_TRUE(replay.isPaused());
  EXPECT_EQ(replay.current(), 7U);
  replay.press("Left");
  replay.press("Left");
  EXPECT_EQ(replay.current(), 5U);
  replay.press("End");
  replay.press("Right");
  EXPECT_EQ(replay.current(), 9U);
  replay.press("Home");
  replay.press("Left");
  EXPECT_EQ(replay.current(), 0U);
  EXPECT_FALSE(replay.press("x"));
}

/// Appends poses, each a metre on from the last.
void writePoses(const std::filesystem::path& folder, int first, int count)
{
  std::ofstream file(folder / "poses.kitti.txt", std::ios::app);
  for (int i = first; i < first + count; ++i) {
    file << "1 0 0 " << i << " 0 1 0 0 0 0 1 0\n";
  }
}

TEST(OdometryResult, FollowsARunThatIsStillAtWork)
{
  const test::TemporaryFolder folder;
  EXPECT_THROW(OdometryResult{folder.path()}, FileError);
  writePoses(folder.path(), 0, 3);
  OdometryResult result(folder.path());
  EXPECT_EQ(result.poses().size(), 3U);
  EXPECT_EQ(result.mapPlanes(), nullptr);
  EXPECT_FALSE(result.refresh());

  std::ofstream(folder.path() / "poses.kitti.txt", std::ios::app) << "1 0 0";  // half a line
  EXPECT_FALSE(result.refresh());
  EXPECT_EQ(result.poses().size(), 3U);
  std::ofstream(folder.path() / "poses.kitti.txt", std::ios::app) << " 3 0 1 0 0 0 0 1 0\n";
  EXPECT_TRUE(result.refresh());
  ASSERT_EQ(result.poses().size(), 4U);
  EXPECT_EQ(result.poses()[3].world_T_sensor.translation.x(), 3.0);

  KeyframeVoxelMap map;
  FeatureSet features;
  features.planes.push_back({1.0F, 2.0F, 3.0F});
  map.insert(features, SE3());
  saveMap(map, folder.path());
  EXPECT_TRUE(result.refresh());
  ASSERT_NE(result.mapPlanes(), nullptr);
  EXPECT_EQ(result.mapPlanes()->size(), 1U);
  EXPECT_FALSE(result.refresh());
}

}  // namespace
}  // namespace pcl_floam::viewer
