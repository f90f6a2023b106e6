// A factor of one's own: a robot on a level floor, whose sensor keeps its height and stays upright.
//
//   ./05_ground_factor SCANS
// prints
//   by its points, up or down by 7.52 mm
//   ...
//   on level ground, up or down by 1.77 mm
#include "each_scan.h"

#include <algorithm>
#include <cmath>

namespace {

/// The world is where the first scan was: height, roll and pitch are zero there.
class LevelGround : public pcl_floam::PoseFactor {
public:
  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    constexpr double kBump = 0.001;  // m
    constexpr double kTilt = 0.001;  // rad
    const Eigen::Vector3d up = world_T_sensor.rotation.col(2);
    pcl_floam::Vector6 derivative;
    derivative << 0.0, 0.0, 1.0, 0.0, 0.0, 0.0;
    equations.add(world_T_sensor.translation.z(), derivative, kBump * kBump);
    for (int axis = 0; axis < 2; ++axis) {  // a turn by w moves it by w x up
      derivative << Eigen::Vector3d::Zero(), up.cross(Eigen::Vector3d::Unit(axis));
      equations.add(up[axis], derivative, kTilt * kTilt);
    }
  }
};

}  // namespace

int main(int argc, char** argv)
{
  for (const bool is_level : {false, true}) {
    pcl_floam::OdometryParameters parameters;
    parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
    pcl_floam::OdometryPipeline odometry(parameters);          // for a known point type: pcl_floam::Odometry<PointT>
    pcl_floam::OdometryComponents components;
    if (is_level) {
      components.factors = {std::make_shared<LevelGround>()};
    }
    odometry.setComponents(components);
    double largest = 0.0;
    const int status = trackEachScan(argc, argv, [&](const pcl_floam::CloudView& scan, std::optional<double> stamp) {
      largest = std::max(largest, std::abs(odometry.track(scan, stamp).world_T_sensor.translation.z()));
      return odometry.report();
    });
    if (status != 0) {
      return status;
    }
    std::cout << (is_level ? "on level ground" : "by its points") << ", up or down by " << 1000.0 * largest << " mm\n";
  }
}
