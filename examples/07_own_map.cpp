// A map of one's own under the odometry: a plain grid of cells, each with the plane or mean of its points.
//
//   ./07_own_map SCANS
// prints
//   000019.pcd: tracked, at     1.30458  0.00380472 -0.00184691
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>
#include <iostream>
#include <map>

namespace {

class Grid : public pcl_floam::SurfaceMap {
public:
  explicit Grid(double side = 1.0) : side_(side) {}

  std::unique_ptr<SurfaceMap> makeEmpty(double side) const override { return std::make_unique<Grid>(2.0 * side); }
  std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<Grid>(*this); }
  bool empty() const override { return cells_.empty(); }
  void clear() override { cells_.clear(); }
  void crop(const Eigen::Vector3d& /*center*/, double /*radius*/) override {}

  void insert(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Cell& cell = cells_[cellAt(places[i])];
      cell.count += 1.0;
      cell.sum += places[i];
      cell.squares += places[i] * places[i].transpose();
    }
  }

  void find(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count,
            pcl_floam::Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      const auto cell = cells_.find(cellAt(places[i]));
      surfaces[i] = cell != cells_.end() && cell->second.count > 5.0 ? surfaceIn(cell->second) : pcl_floam::Surface();
    }
  }

private:
  struct Cell {
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  };

  std::array<int, 3> cellAt(const Eigen::Vector3d& p) const
  {
    const auto n = [this](double x) { return static_cast<int>(std::floor(x / side_)); };
    return {n(p.x()), n(p.y()), n(p.z())};
  }

  /// The plane through a cell's points, or their mean.
  pcl_floam::Surface surfaceIn(const Cell& cell) const
  {
    pcl_floam::Surface surface;
    surface.center = cell.sum / cell.count;
    const Eigen::Matrix3d covariance = cell.squares / cell.count - surface.center * surface.center.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
    const bool is_plane = axes.eigenvalues()[0] < 0.05 * axes.eigenvalues()[1];
    surface.kind = is_plane ? pcl_floam::SurfaceKind::plane : pcl_floam::SurfaceKind::point;
    surface.direction = axes.eigenvectors().col(0);
    surface.thickness = std::max(0.0, axes.eigenvalues()[is_plane ? 0 : 2]);
    surface.extent = axes.eigenvalues()[1];
    surface.count = static_cast<std::uint32_t>(cell.count);
    surface.size = side_;
    return surface;
  }

  double side_;
  std::map<std::array<int, 3>, Cell> cells_;
};

}  // namespace

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl_floam::OdometryComponents components;
  components.map = std::make_shared<Grid>();
  pcl_floam::OdometryPipeline odometry;
  odometry.setComponents(components);
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    std::cout << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << '\n';
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
