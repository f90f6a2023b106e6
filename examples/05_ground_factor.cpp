// A factor of one's own: a robot on a level floor, whose sensor keeps its height and stays upright.
//
//   ./05_ground_factor SCANS
// prints
//   by its points, up or down by 7.64623 mm
//   on level ground, up or down by 2.38778 mm
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

/// The world is where the first scan was: height, roll and pitch are zero there.
struct LevelGround : pcl_floam::PoseFactor {
  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    constexpr double kBump = 0.001;  // m
    constexpr double kTilt = 0.001;  // rad
    const Eigen::Vector3d up = world_T_sensor.rotation.col(2);
    pcl_floam::Vector6 derivative;  // by a shift, m, and a turn, rad
    derivative << Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero();
    equations.add(world_T_sensor.translation.z(), derivative, kBump * kBump);
    for (int axis = 0; axis < 2; ++axis) {  // a turn by w moves it by w x up
      derivative << Eigen::Vector3d::Zero(), up.cross(Eigen::Vector3d::Unit(axis));
      equations.add(up[axis], derivative, kTilt * kTilt);
    }
  }
};

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  for (const bool is_level : {false, true}) {
    pcl_floam::OdometryParameters parameters;
    parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
    pcl_floam::OdometryPipeline odometry(parameters);          // for a known point type: pcl_floam::Odometry<PointT>
    if (is_level) {
      pcl_floam::OdometryComponents components;
      components.factors = {std::make_shared<LevelGround>()};
      odometry.setComponents(components);
    }
    double largest = 0.0;
    pcl::PCLPointCloud2 scan;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      scans.read(i, scan);
      const pcl_floam::SE3 world_T_sensor = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i)).world_T_sensor;
      largest = std::max(largest, std::abs(world_T_sensor.translation.z()));
    }
    std::cout << (is_level ? "on level ground" : "by its points") << ", up or down by " << 1000.0 * largest << " mm\n";
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
