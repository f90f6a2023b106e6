// A factor of one's own that learns from the scans: returns are as bright as the map is where they fall.
//
//   ./06_intensity_factor SCANS
// prints
//   000019.pcd: tracked, at     1.25808 -0.00105192  0.00371405
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <vector>

namespace {

class Brightness : public pcl_floam::PoseFactor {
public:
  void setScan(const pcl_floam::CloudView& scan)
  {
    scan_.clear();
    for (std::size_t i = 0; i < scan.size; i += kEvery) {
      if (std::isfinite(scan.x(i))) {
        scan_.push_back({{scan.x(i), scan.y(i), scan.z(i)}, scan.intensityOf(i)});
      }
    }
  }

  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    for (const Return& r : scan_) {
      const Eigen::Vector3d arm = world_T_sensor.rotation * r.place;
      const Eigen::Vector3d place = world_T_sensor.translation + arm;
      const std::optional<double> here = at(place);
      Eigen::Vector3d slope = Eigen::Vector3d::Zero();
      for (int axis = 0; here && axis < 3; ++axis) {
        const Eigen::Vector3d step = kSide * Eigen::Vector3d::Unit(axis);
        const std::optional<double> before = at(place - step), after = at(place + step);
        slope[axis] = before && after ? (*after - *before) / (2.0 * kSide) : 0.0;
      }
      pcl_floam::Vector6 derivative;
      derivative << slope, arm.cross(slope);
      equations.add(here ? *here - r.intensity : 0.0, derivative, kNoise * kNoise);
    }
  }

  void addScan(const pcl_floam::SE3& world_T_sensor)
  {
    for (const Return& r : scan_) {
      Cell& cell = cells_[cellAt(world_T_sensor * r.place)];
      cell.sum += r.intensity;
      cell.count += 1.0;
    }
  }

private:
  static constexpr std::size_t kEvery = 20;
  static constexpr double kSide = 0.25;   // m
  static constexpr double kNoise = 50.0;  // of intensities from 0 to 255, shared by many returns
  struct Return {
    Eigen::Vector3d place;
    float intensity;
  };
  struct Cell {
    double sum = 0.0, count = 0.0;
  };
  using Key = std::array<int, 3>;

  static Key cellAt(const Eigen::Vector3d& p)
  {
    const auto n = [](double x) { return static_cast<int>(std::floor(x / kSide)); };
    return {n(p.x()), n(p.y()), n(p.z())};
  }
  std::optional<double> at(const Eigen::Vector3d& p) const
  {
    const auto cell = cells_.find(cellAt(p));
    return cell == cells_.end() ? std::nullopt : std::optional(cell->second.sum / cell->second.count);
  }

  std::vector<Return> scan_;
  std::map<Key, Cell> cells_;
};

}  // namespace

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  const auto brightness = std::make_shared<Brightness>();
  pcl_floam::OdometryParameters parameters;
  parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
  pcl_floam::OdometryPipeline odometry(parameters);
  pcl_floam::OdometryComponents components;
  components.factors = {brightness};
  odometry.setComponents(components);
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    brightness->setScan(pcl_floam::viewOf(scan));
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    brightness->addScan(report.world_T_sensor);
    std::cout << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << '\n';
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
