// Sequences as KITTI's odometry benchmark has them.

#include "kitti_sequence_writer.h"
#include "support/temporary_folder.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

SimulationOptions fastRoom()
{
  SimulationOptions options;
  options.world = "handheld";
  options.start = 8.0;
  options.range_noise = 0.0;
  return options;
}

}  // namespace

TEST(KittiSequence, ScansAreCompensatedAtTheMiddle)
{
  Simulation simulation(fastRoom());
  const Sweep sweep = simulation.sweep(3);
  const Sweep compensated = compensatedAtMiddle(simulation, sweep);
  const SE3 middle_T_end = sweep.world_T_middle.inverse() * sweep.world_T_end;
  double moved = 0.0;
  ASSERT_EQ(compensated.cloud.size(), sweep.cloud.size());
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const Eigen::Vector3d exact = middle_T_end * sweep.exact_at_end[i].cast<double>();
    ASSERT_LT((compensated.cloud[i].getVector3fMap().cast<double>() - exact).norm(), 1e-4);
    moved = std::max(
        moved, static_cast<double>((compensated.cloud[i].getVector3fMap() - sweep.cloud[i].getVector3fMap()).norm()));
  }
  EXPECT_GT(moved, 0.05);
}

TEST(KittiSequence, TreeIsLaidOutAsKittis)
{
  const test::TemporaryFolder folder;
  Simulation simulation(fastRoom());
  {
    KittiSequenceWriter writer(folder.path(), "07");
    for (std::size_t number = 0; number < 3; ++number) {
      writer.write(simulation, simulation.sweep(number));
    }
  }
  const ScanSource scans(folder.path() / "sequences/07");
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_TRUE(scans.stamp(2).has_value());
  EXPECT_EQ(test::contentOf(folder.path() / "sequences/07/calib.txt").rfind("Tr: ", 0), 0U);
  const Trajectory poses = readTrajectory(folder.path() / "poses/07.txt");
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_LT(log(poses[0].world_T_sensor).norm(), 1e-9);
  // A turn of the lidar is the same turn of the camera about other axes; what is the lidar's forward is the camera's z.
  const SE3 motion = simulation.sweep(0).world_T_middle.inverse() * simulation.sweep(2).world_T_middle;
  EXPECT_NEAR(rotationAngle(poses[2].world_T_sensor.rotation), rotationAngle(motion.rotation), 1e-9);
  EXPECT_NEAR(poses[2].world_T_sensor.rotation(2, 2), motion.rotation(0, 0), 1e-9);
  EXPECT_THROW(KittiSequenceWriter(folder.path(), "07"), std::runtime_error);
}

}  // namespace pcl_floam::simulator
