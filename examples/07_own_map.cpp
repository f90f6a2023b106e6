// A map of one's own under the odometry: the cells of PCL's NDT, each with the plane or the mean of its points.
//
//   ./07_own_map SCANS
// prints
//   000019.pcd: tracked, at       1.3101 -0.00248991  0.00827797
#include <pcl/filters/voxel_grid_covariance.h>
#include "each_scan.h"

class NdtMap : public pcl_floam::SurfaceMap {
  using Cells = pcl::VoxelGridCovariance<pcl::PointXYZ>;
  static constexpr float kSide = 1.5F;  // m
  static constexpr int kFewest = 6;     // points of a plane; more are not surer, as a cell so wide is not flat
  pcl::PointCloud<pcl::PointXYZ> points_;
  std::shared_ptr<Cells> cells_;

public:
  std::unique_ptr<SurfaceMap> makeEmpty(double /*side*/) const override { return std::make_unique<NdtMap>(); }
  std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<NdtMap>(*this); }
  bool empty() const override { return points_.empty(); }
  void clear() override { points_.clear(); }
  void crop(const Eigen::Vector3d& /*center*/, double /*radius*/) override {}
  void insert(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count) override
  {
    std::for_each(places, places + count, [&](const Eigen::Vector3d& place) {
      points_.push_back(pcl::PointXYZ());
      points_.back().getVector3fMap() = place.cast<float>();
    });
    cells_ = std::make_shared<Cells>();
    cells_->setLeafSize(kSide, kSide, kSide);
    cells_->setInputCloud(points_.makeShared());
    cells_->filter();
  }
  void find(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count,
            pcl_floam::Surface* surfaces) const override
  {
    std::transform(places, places + count, surfaces, [this](const Eigen::Vector3d& place) -> pcl_floam::Surface {
      Eigen::Vector3f there = place.cast<float>();
      const auto* cell = empty() || !place.allFinite() ? nullptr : cells_->getLeaf(there);
      if (cell == nullptr || cell->getPointCount() < kFewest || (cell->getMean() - place).norm() > kSide) {
        return {};
      }
      const Eigen::Vector3d variances = cell->getEvals();  // rising
      const auto kind =
          variances[0] < 0.05 * variances[1] ? pcl_floam::SurfaceKind::plane : pcl_floam::SurfaceKind::point;
      const double thickness = kind == pcl_floam::SurfaceKind::plane ? variances[0] : variances[2];
      return {
          kind, cell->getMean(), cell->getEvecs().col(0), Eigen::Matrix3d::Identity(), thickness, variances[1], kFewest,
          kSide};
    });
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
