// A map of one's own under the odometry: cells of one size, as NDT has them, each with the plane of its points.
//
//   ./07_own_map SCANS
// prints
//   000019.pcd: tracked, at 1.31 0.00 0.01 m
#include <bitset>
#include <Eigen/Eigenvalues>
#include <map>
#include "each_scan.h"

class NdtMap : public pcl_floam::SurfaceMap {
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
    std::uint32_t count = 0;
    std::bitset<128> lasers;  // that have seen it: what one draws by itself, on whatever it hits, is no plane
    [[nodiscard]] pcl_floam::Surface planeFor(std::uint32_t laser) const
    {
      pcl_floam::Surface plane;
      const Eigen::Vector3d mean = sum / count;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(outer / count - mean * mean.transpose());
      const Eigen::Vector3d variances = eigen.eigenvalues();  // rising
      const std::size_t others = lasers.count() - (lasers.test(laser % 128) ? 1 : 0);
      if (count > 5 && others > 1 && variances[0] < 0.5 * variances[1]) {
        plane.kind = pcl_floam::SurfaceKind::plane;
        plane.center = mean;
        plane.direction = eigen.eigenvectors().col(0);
        plane.thickness = variances[0];
        plane.extent = variances[1];
        plane.count = count;
      }
      return plane;
    }
  };
  static constexpr double kSide = 2.5;  // m
  std::map<std::array<double, 3>, Cell> cells_;

  static std::array<double, 3> keyOf(const Eigen::Vector3d& p)
  {
    return {std::floor(p.x() / kSide), std::floor(p.y() / kSide), std::floor(p.z() / kSide)};
  }

public:
  std::unique_ptr<SurfaceMap> makeEmpty(double /*side*/) const override { return std::make_unique<NdtMap>(); }
  std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<NdtMap>(*this); }
  bool empty() const override { return cells_.empty(); }
  void clear() override { cells_.clear(); }
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Cell& cell = cells_[keyOf(places[i])];
      cell.sum += places[i];
      cell.outer += places[i] * places[i].transpose();
      cell.lasers.set(lasers[i] % 128);
      ++cell.count;
    }
  }
  void find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
            pcl_floam::Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      const auto found = places[i].allFinite() ? cells_.find(keyOf(places[i])) : cells_.end();
      surfaces[i] = found == cells_.end() ? pcl_floam::Surface() : found->second.planeFor(lasers[i]);
    }
  }
};

int main(int argc, char** argv)
{
  pcl_floam::OdometryPipeline odometry;
  odometry.setComponents({{}, {}, {}, std::make_shared<NdtMap>()});
  return trackEachScan(argc, argv, [&](const auto& scan, const auto& stamp) { return odometry.track(scan, stamp); });
}
