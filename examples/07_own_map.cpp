// A map of one's own under the odometry: cells of one size, as NDT has them, each with the plane or the mean of its
// points.
//
//   ./07_own_map SCANS
// prints
//   000019.pcd: tracked, at     1.31006 -0.00069719  0.00339127
#include <bitset>
#include <Eigen/Eigenvalues>
#include <map>
#include "each_scan.h"

class NdtMap : public pcl_floam::SurfaceMap {
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
    std::uint32_t count = 0;
    std::bitset<128> lasers;  // that have seen it
  };
  static constexpr double kSide = 2.5;  // m
  static constexpr int kFewest = 6;     // points of a plane; more are not surer, as a cell so wide is not flat
  std::map<std::array<double, 3>, Cell> cells_;

  static std::array<double, 3> keyOf(const Eigen::Vector3d& place)
  {
    return {std::floor(place.x() / kSide), std::floor(place.y() / kSide), std::floor(place.z() / kSide)};
  }
  pcl_floam::Surface surfaceAt(const Eigen::Vector3d& place, std::uint32_t laser) const
  {
    const auto found = place.allFinite() ? cells_.find(keyOf(place)) : cells_.end();
    if (found == cells_.end() || found->second.count < kFewest) {
      return {};
    }
    const Cell& cell = found->second;
    std::bitset<128> others = cell.lasers;  // what a laser draws, on whatever it hits, is no support for its own points
    if (laser != pcl_floam::kNoLaser) {
      others.reset(laser % 128);
    }
    if (others.count() < 2) {
      return {};
    }
    const Eigen::Vector3d mean = cell.sum / cell.count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cell.outer / cell.count - mean * mean.transpose());
    const Eigen::Array3d variances = eigen.eigenvalues();  // rising
    const bool is_plane = variances[0] < 0.05 * variances[1];
    // What fills its cell evenly, with a variance of the squared side over 12, tells nothing of the way along it.
    const Eigen::Vector3d felt = (1.0 - 12.0 / (kSide * kSide) * variances).max(0.0);
    const Eigen::Matrix3d& axes = eigen.eigenvectors();
    return {is_plane ? pcl_floam::SurfaceKind::plane : pcl_floam::SurfaceKind::point,
            mean,
            axes.col(0),
            axes * felt.asDiagonal() * axes.transpose(),
            is_plane ? variances[0] : variances[2],
            variances[1],
            kFewest,
            kSide};
  }

public:
  std::unique_ptr<SurfaceMap> makeEmpty(double /*side*/) const override { return std::make_unique<NdtMap>(); }
  std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<NdtMap>(*this); }
  bool empty() const override { return cells_.empty(); }
  void clear() override { cells_.clear(); }
  void crop(const Eigen::Vector3d& /*center*/, double /*radius*/) override {}
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
      surfaces[i] = surfaceAt(places[i], lasers[i]);
    }
  }
};

int main(int argc, char** argv)
{
  pcl_floam::OdometryComponents components;
  components.map = std::make_shared<NdtMap>();
  pcl_floam::OdometryPipeline odometry;
  odometry.setComponents(components);
  return trackEachScan(argc, argv, [&](const pcl_floam::CloudView& scan, std::optional<double> stamp) {
    return odometry.track(scan, stamp);
  });
}
