// A factor of one's own that learns from the scans: returns are as bright as the map is where they fall.
//
//   ./06_intensity_factor SCANS
// prints
//   000019.pcd: tracked, at 1.26 0.00 0.00 m
#include "each_scan.h"

struct Brightness : pcl_floam::PoseFactor {
  static constexpr double kSide = 0.25;  // m, of cells that keep the mean of what was seen in them
  std::map<std::array<double, 3>, std::pair<double, double>> cells;  // mean, count
  pcl_floam::CloudView scan;                                         // the present one

  static auto keyOf(const Eigen::Vector3d& p) { return std::array{rint(p.x()), rint(p.y()), rint(p.z())}; }
  double at(const Eigen::Vector3d& place) const  // NaN where nothing was seen
  {
    const auto cell = place.allFinite() ? cells.find(keyOf(place / kSide)) : cells.end();
    return cell == cells.end() ? std::nan("") : cell->second.first;
  }
  void learn(const pcl_floam::SE3& world_T_sensor)
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      if (const Eigen::Vector3d place(scan.x(i), scan.y(i), scan.z(i)); place.allFinite()) {
        auto& [mean, count] = cells[keyOf(world_T_sensor * place / kSide)];
        mean += (scan.intensityOf(i) - mean) / ++count;
      }
    }
  }
  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      const Eigen::Vector3d arm = world_T_sensor.rotation * Eigen::Vector3d(scan.x(i), scan.y(i), scan.z(i));
      const double here = at(world_T_sensor.translation + arm);
      pcl_floam::Vector6 slope = pcl_floam::Vector6::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        const double there = at(world_T_sensor.translation + arm + kSide * Eigen::Vector3d::Unit(axis));
        slope[axis] = std::isfinite(there - here) ? (there - here) / kSide : 0.0;
      }
      slope.tail<3>() = arm.cross(slope.head<3>());
      if (std::isfinite(here)) {
        equations.add(here - scan.intensityOf(i), slope, 2500.0);  // of 0 to 255
      }
    }
  }
};

int main(int argc, char** argv)
{
  pcl_floam::OdometryParameters parameters;
  parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
  pcl_floam::OdometryPipeline odometry(parameters);
  pcl_floam::OdometryComponents components;
  const auto brightness = std::make_shared<Brightness>();
  components.factors = {brightness};
  odometry.setComponents(components);
  return trackEachScan(argc, argv, [&](const pcl_floam::CloudView& scan, std::optional<double> stamp) {
    brightness->scan = scan;
    brightness->learn(odometry.track(scan, stamp).world_T_sensor);
    return odometry.report();
  });
}
