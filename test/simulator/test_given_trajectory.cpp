// Worlds along a trajectory that is given.

#include "height_raster.h"
#include "simulation.h"
#include "support/constants.h"
#include "trajectory_file.h"
#include "world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace pcl_floam::simulator {

using pcl_floam::test::kPi;

/// A camera that drives ahead at 10 m/s, climbs by 0.05 m a metre and turns left by 0.2 degrees a metre.
class GivenTrajectory : public testing::Test {
protected:
  void SetUp() override
  {
    file_ = std::filesystem::temp_directory_path() /
            ("trajectory_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".txt");
    std::ofstream stream(file_);
    stream.precision(12);
    double x = 0.0;
    double z = 0.0;
    for (int i = 0; i < 300; ++i) {
      const double yaw = 0.2 * kPi / 180.0 * i;  // to the left: the camera's z axis goes towards its -x
      stream << std::cos(yaw) << " 0 " << -std::sin(yaw) << ' ' << x << " 0 1 0 " << -0.05 * i << ' ' << std::sin(yaw)
             << " 0 " << std::cos(yaw) << ' ' << z << '\n';
      x -= std::sin(yaw);
      z += std::cos(yaw);
    }
  }
  void TearDown() override { std::filesystem::remove(file_); }

  [[nodiscard]] WorldOptions options(double from, double length) const
  {
    WorldOptions result;
    result.family = Family::test;
    result.trajectory = {file_.string(), from, length};
    return result;
  }

  std::filesystem::path file_;
};

TEST_F(GivenTrajectory, IsReadInABodysAxes)
{
  const std::vector<BodyState> states = readTrajectoryPart({file_.string(), 100.0, 50.0});
  ASSERT_NEAR(static_cast<double>(states.size()), 51.0, 2.0);
  EXPECT_EQ(states.front().head<3>().norm(), 0.0);
  EXPECT_NEAR(states.front()[3], 0.0, 1e-9);
  EXPECT_NEAR(states[40][3], 40 * 0.2 * kPi / 180.0, 1e-6) << "turns to the left";
  EXPECT_NEAR(states[40][2], 2.0, 1e-3) << "climbs";
  EXPECT_GT(states[40][0], 38.0) << "goes ahead";
  EXPECT_GT(states[40][1], 1.0) << "and to the left";
}

TEST_F(GivenTrajectory, IsWhatTheSensorFollows)
{
  for (const char* name : {"town", "motorway"}) {
    const MotionSpline motion = makeWorld(name, options(0.0, 150.0)).sensor_motion;
    const std::vector<BodyState> states = readTrajectoryPart({file_.string(), 0.0, 150.0});
    // The spline's k-th knot lies near its (k+1)-th control.
    for (const std::size_t i : {10U, 60U, 120U}) {
      const Eigen::Vector3d apart = motion.pose(0.1 * static_cast<double>(i)).translation - states[i + 1].head<3>();
      EXPECT_LT(apart.norm(), 0.02) << name;
    }
  }
}

TEST_F(GivenTrajectory, RefusesWhatIsNotThere)
{
  EXPECT_THROW((void)readTrajectoryPart({"/nowhere.txt", 0.0, 100.0}), std::invalid_argument);
  EXPECT_THROW((void)readTrajectoryPart({file_.string(), 5000.0, 100.0}), std::invalid_argument);
  std::ofstream(file_, std::ios::app) << "1 2 3\n";
  EXPECT_THROW((void)readTrajectoryPart({file_.string(), 0.0, 1000.0}), std::invalid_argument);
}

TEST(HeightRaster, FollowsThePath)
{
  std::vector<Eigen::Vector3d> path;
  for (int i = 0; i < 60; ++i) {
    path.emplace_back(3.0 * i, 0.0, 0.15 * i);
  }
  const HeightRaster raster(path, 40.0);
  for (const double x : {30.0, 61.0, 120.5}) {
    EXPECT_NEAR(raster.height(x, 0.0), 0.05 * x, 0.05) << x;
    EXPECT_NEAR(raster.height(x, 30.0), 0.05 * x, 0.6) << x;
  }
}

TEST(HeightRaster, HasACrossSection)
{
  std::vector<Eigen::Vector3d> path;
  for (int i = 0; i < 60; ++i) {
    path.emplace_back(3.0 * i, 0.0, 0.0);
  }
  const auto section = [](double along, double left) { return left > 5.0 ? 0.01 * along : (left < -5.0 ? -1.0 : 0.0); };
  const HeightRaster raster(path, 40.0, section);
  EXPECT_NEAR(raster.height(90.0, 0.0), 0.0, 1e-6);
  EXPECT_NEAR(raster.height(90.0, 20.0), 0.9, 0.05) << "to the left of a path along x";
  EXPECT_NEAR(raster.height(90.0, -20.0), -1.0, 1e-6);
}

/// Returns of one sweep that stand over the road's level, as a part of all.
double shareAbove(const SimulationOptions& options, double height)
{
  const Sweep sweep = Simulation(options).sweep(0);
  const auto above = std::count_if(sweep.cloud.begin(), sweep.cloud.end(),
                                   [height](const PointXYZIRT& point) { return point.z > height; });
  return static_cast<double>(above) / static_cast<double>(sweep.cloud.size());
}

TEST_F(GivenTrajectory, HasGrowthBesideMotorwaysAndStreets)
{
  for (const char* name : {"town", "motorway"}) {
    SimulationOptions simulated;
    simulated.world = name;
    simulated.family = Family::test;
    simulated.trajectory = {file_.string(), 0.0, 150.0};
    EXPECT_GT(shareAbove(simulated, -1.0), 0.05) << name;
  }
}

}  // namespace pcl_floam::simulator
