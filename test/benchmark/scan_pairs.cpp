#include "benchmark/scan_pairs.h"

#include "support/random_motion.h"

#include <pcl_floam/io/trajectory.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>

#ifdef PCL_FLOAM_WITH_SIMULATOR
#include "simulation.h"
#include "support/constants.h"
#endif

namespace pcl_floam::benchmark {

namespace {

using pcl_floam::test::kPi;

CloudPair makeScanPair(Cloud::Ptr source, Cloud::Ptr target, const SE3& target_T_source, double success)
{
  CloudPair pair;
  pair.extent = extentOf(*source);
  pair.source = std::move(source);
  pair.target = std::move(target);
  pair.target_T_source = target_T_source;
  pair.ndt_resolution = pair.extent > 5.0 ? 1.0 : 0.5;
  pair.success = success;
  return pair;
}

#ifdef PCL_FLOAM_WITH_SIMULATOR
/// A sweep as if taken in an instant, at its end.
Cloud::Ptr compensated(const simulator::Sweep& sweep, std::mt19937& random)
{
  auto cloud = pcl::make_shared<Cloud>();
  const std::size_t every = sweep.exact_at_end.size() > 40000 ? 2 : 1;  // for the sake of the slowest method
  for (std::size_t i = 0; i < sweep.exact_at_end.size(); i += every) {
    const Eigen::Vector3f& exact = sweep.exact_at_end[i];
    const double noise = 0.01 * (test::uniform(random, 1.7) + test::uniform(random, 1.0));
    Point point;
    point.getVector3fMap() = exact * static_cast<float>(1.0 + noise / static_cast<double>(exact.norm()));
    cloud->push_back(point);
  }
  return cloud;
}
#endif

Cloud::Ptr readKittiScan(const std::string& data, std::size_t number, std::size_t every)
{
  std::ostringstream name;
  name << data << "/kitti_raw_0001/velodyne/" << std::setfill('0') << std::setw(10) << number << ".bin";
  std::ifstream file(name.str(), std::ios::binary);
  auto cloud = pcl::make_shared<Cloud>();
  float values[4];
  for (std::size_t i = 0; file.read(reinterpret_cast<char*>(values), sizeof(values)); ++i) {
    if (i % every != 0) {
      continue;
    }
    Point point;
    point.getVector3fMap() = Eigen::Vector3f(values[0], values[1], values[2]);
    point.intensity = values[3];
    cloud->push_back(point);
  }
  return cloud;
}

/// The motion during a sweep taken out: the head turns clockwise and looks forward in the middle.
void compensate(Cloud& cloud, const Vector6& motion)
{
  for (Point& point : cloud) {
    const double fraction = -std::atan2(point.y, point.x) / (2.0 * kPi);
    const SE3 correction = exp(Vector6(fraction * motion));
    point.getVector3fMap() = (correction * point.getVector3fMap().cast<double>()).cast<float>();
  }
}

}  // namespace

PairKind simulatedScans([[maybe_unused]] const std::string& world, [[maybe_unused]] const std::string& sensor,
                        [[maybe_unused]] unsigned seed)
{
  PairKind kind;
#ifdef PCL_FLOAM_WITH_SIMULATOR
  simulator::SimulationOptions options;
  options.world = world;
  options.sensor = sensor;
  options.seed = 7 + seed;
  simulator::Simulation simulation(options);
  std::mt19937 random(1 + seed);
  for (std::size_t first : {20U, 120U, 220U, 320U}) {
    const simulator::Sweep target = simulation.sweep(first);
    const simulator::Sweep source = simulation.sweep(first + 5);
    const CloudPair pair = makeScanPair(compensated(source, random), compensated(target, random),
                                        target.world_T_end.inverse() * source.world_T_end, 0.5);
    (first < 300U ? kind.pairs : kind.grid_pairs).push_back(pair);
  }
#endif
  return kind;
}

PairKind realScans(const std::string& data, std::size_t every)
{
  PairKind kind;
  const std::string poses_file = data + "/kitti_raw_0001/poses.txt";
  if (!std::filesystem::exists(poses_file)) {
    return kind;
  }
  const Trajectory poses = readTrajectory(poses_file, TrajectoryFormat::kitti);
  for (const std::size_t number : {15U, 35U, 55U, 75U, 95U}) {
    const auto scan = [&](std::size_t n) {
      auto cloud = readKittiScan(data, n, every);
      compensate(*cloud, Vector6(0.5 * log(poses[n - 1].world_T_sensor.inverse() * poses[n + 1].world_T_sensor)));
      return cloud;
    };
    kind.pairs.push_back(makeScanPair(scan(number + 1), scan(number),
                                      poses[number].world_T_sensor.inverse() * poses[number + 1].world_T_sensor, 0.3));
  }
  return kind;
}

}  // namespace pcl_floam::benchmark
