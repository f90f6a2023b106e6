// Odometries in threads, copied and moved: the same bits.
#include "support/moving_room.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <utility>
#include <vector>

namespace pcl_floam::test {
namespace {

/// All bits of the poses and of the map of a short run.
std::vector<double> resultOf(const std::vector<Cloud>& scans, int threads)
{
  OdometryParameters parameters = defaults();
  parameters.threads = threads;
  parameters.keyframe.translation = 0.0;  // so many keyframes that the map also forgets
  Odometry<PointXYZIRT> odometry(parameters);
  std::vector<double> numbers;
  for (const Cloud& scan : scans) {
    const Eigen::Matrix4d pose = odometry.track(scan).world_T_sensor.matrix();
    numbers.insert(numbers.end(), pose.data(), pose.data() + pose.size());
  }
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    for (const Eigen::Vector3d& point : odometry.map().points(kind)) {
      numbers.insert(numbers.end(), point.data(), point.data() + point.size());
    }
  }
  return numbers;
}

TEST(Odometry, SameBitsForEveryNumberOfThreadsAndEveryRun)
{
  std::vector<Cloud> scans;
  for (int k = 0; k < 9; ++k) {
    scans.push_back(sweep(acceleratedPath, k));
  }
  const std::vector<double> once = resultOf(scans, 1);
  for (const int threads : {1, 2, 3, 8}) {
    EXPECT_EQ(resultOf(scans, threads), once) << threads << " threads";
  }
}

TEST(Odometry, ObjectsInThreadsOfTheirOwnDoNotDisturbEachOther)
{
  std::vector<Cloud> scans;
  for (int k = 0; k < 7; ++k) {
    scans.push_back(sweep(acceleratedPath, k));
  }
  const std::vector<double> alone = resultOf(scans, 1);
  std::array<std::vector<double>, 3> together;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < together.size(); ++i) {
    threads.emplace_back([&scans, &result = together[i], i] { result = resultOf(scans, 1 + static_cast<int>(i % 2)); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const std::vector<double>& result : together) {
    EXPECT_EQ(result, alone);
  }
}

TEST(Odometry, ThreadsMayTakeTurnsAndAMoveKeepsTheState)
{
  Odometry<PointXYZIRT> here(defaults());
  Odometry<PointXYZIRT> moving(defaults());
  for (int k = 0; k < 7; ++k) {
    const Cloud scan = sweep(acceleratedPath, k);
    here.track(scan);
    std::thread([&moving, &scan] { moving.track(scan); }).join();
    Odometry<PointXYZIRT> elsewhere(std::move(moving));
    EXPECT_TRUE(sameBits(elsewhere.getPose(), here.getPose())) << "scan " << k;
    moving = std::move(elsewhere);
  }
  EXPECT_EQ(moving.map().size(FeatureKind::plane), here.map().size(FeatureKind::plane));
}

TEST(Odometry, ACopyContinuesIdentically)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < 4; ++k) {
    odometry.track(sweep(acceleratedPath, k));
  }
  Odometry<PointXYZIRT> copy(odometry);
  Odometry<PointXYZIRT> assigned(defaults());
  assigned = odometry;
  for (int k = 4; k < 8; ++k) {
    odometry.track(sweep(acceleratedPath, k));  // first the one, then the others: they share nothing
  }
  for (int k = 4; k < 8; ++k) {
    copy.track(sweep(acceleratedPath, k));
    assigned.track(sweep(acceleratedPath, k));
  }
  EXPECT_TRUE(sameBits(odometry.getPose(), copy.getPose()));
  EXPECT_TRUE(sameBits(odometry.getPose(), assigned.getPose()));
}

}  // namespace
}  // namespace pcl_floam::test
