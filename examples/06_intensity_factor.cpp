// A factor of one's own that learns from the scans: returns are as bright as the map is where they fall.
//
//   ./06_intensity_factor SCANS
// prints
//   000019.pcd: tracked, at 1.26 0.00 0.00 m
#include <map>
#include "each_scan.h"

class Brightness : public pcl_floam::PoseFactor {
public:
  pcl_floam::CloudView scan;  // the present one
  void addScan(const pcl_floam::SE3& world_T_sensor)
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      auto& [sum, count] = cells_[cellAt(world_T_sensor * Eigen::Vector3d(scan.x(i), scan.y(i), scan.z(i)))];
      sum += scan.intensityOf(i);
      count += 1.0;
    }
  }
  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      const Eigen::Vector3d arm = world_T_sensor.rotation * Eigen::Vector3d(scan.x(i), scan.y(i), scan.z(i));
      const Eigen::Vector3d place = world_T_sensor.translation + arm;
      Eigen::Vector3d slope;
      for (int axis = 0; axis < 3; ++axis) {
        const double rise =
            at(place + kSide * Eigen::Vector3d::Unit(axis)) - at(place - kSide * Eigen::Vector3d::Unit(axis));
        slope[axis] = std::isfinite(rise) ? rise / (2.0 * kSide) : 0.0;
      }
      if (const double off = at(place) - scan.intensityOf(i); std::isfinite(off) && arm.allFinite()) {
        equations.add(off, (pcl_floam::Vector6() << slope, arm.cross(slope)).finished(), 2500.0);  // of 0 to 255
      }
    }
  }

private:
  static constexpr double kSide = 0.25;  // m, of cells that keep the mean of what was seen in them
  static std::array<long, 3> cellAt(const Eigen::Vector3d& p)
  {
    return {std::lround(p.x() / kSide), std::lround(p.y() / kSide), std::lround(p.z() / kSide)};
  }
  double at(const Eigen::Vector3d& p) const  // NaN where nothing was seen
  {
    const auto cell = cells_.find(cellAt(p));
    return cell == cells_.end() ? std::nan("") : cell->second.first / cell->second.second;
  }
  std::map<std::array<long, 3>, std::pair<double, double>> cells_;  // sum, count
};

int main(int argc, char** argv)
{
  const auto brightness = std::make_shared<Brightness>();
  pcl_floam::OdometryParameters parameters;
  parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
  pcl_floam::OdometryPipeline odometry(parameters);
  odometry.setComponents({{brightness}, {}, {}, {}});
  return trackEachScan(argc, argv, [&](const pcl_floam::CloudView& scan, std::optional<double> stamp) {
    brightness->scan = scan;
    const pcl_floam::OdometryReport& report = odometry.track(scan, stamp);
    brightness->addScan(report.world_T_sensor);
    return report;
  });
}
