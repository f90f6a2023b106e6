#include "filters/spin_axis.h"

#include <Eigen/Eigenvalues>

#include <cstddef>

namespace pcl_floam {

namespace {

Eigen::Vector3d beamOf(const ScanPoint& point)
{
  return Eigen::Vector3d(point.x, point.y, point.z).normalized();
}

}  // namespace

Eigen::Vector3d spinAxis(const std::vector<ScanPoint>& points)
{
  constexpr std::size_t kFewest = 20;  // of a laser
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (; end < points.size() && points[end].laser == points[begin].laser; ++end) {
      const Eigen::Vector3d beam = beamOf(points[end]);
      sum += beam;
      squares += beam * beam.transpose();
    }
    if (end - begin >= kFewest) {
      scatter += squares - sum * sum.transpose() / static_cast<double>(end - begin);
    }
  }
  return scatter.isZero(0.0)
             ? Eigen::Vector3d(Eigen::Vector3d::Zero())
             : Eigen::Vector3d(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0));
}

}  // namespace pcl_floam
