// CloudMatching: what its matches say of the pose.
#include "registration/cloud_matching.h"
#include "registration/robust_kernel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

/// As many as have room for their rows.
constexpr std::size_t kResidualsPerChunk = ResidualRows::kRoom / 3;

constexpr double kPointDeviations = 2.0;
constexpr double kSmallestScale = 1e-4;  ///< of the kernel, in spacings

}  // namespace

/// Of a source point and a target point.
CloudMatching::Residual CloudMatching::residual(const SE3& pose, std::size_t i, std::size_t j) const
{
  LocalShape turned = source_.shapes[i];
  turned.axis = (pose.rotation * turned.axis.cast<double>()).cast<float>();
  const Eigen::Matrix3d c = target_.shapes[j].covariance(along_) + turned.covariance(along_);
  const auto onSurface = [](const CloudLevel& level, std::size_t point) {
    return Eigen::Vector3d((level.tree.points()[point] + level.shapes[point].to_surface).cast<double>());
  };
  const Eigen::Vector3d difference = pose * onSurface(source_, i) - onSurface(target_, j);
  const Eigen::Matrix3d m = 2.0 * along_ * c.inverse();  // one across two parallel planes
  const auto squared = static_cast<float>(std::max(0.0, difference.dot(m * difference)));
  return {difference.cast<float>(), m.cast<float>(), squared};
}

void CloudMatching::weigh(const SE3& pose)
{
#pragma omp parallel for num_threads(run_.threads) schedule(static)
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] >= 0) {
      residuals_[i] = residual(pose, i, static_cast<std::size_t>(match_[i]));
    } else {
      residuals_[i].squared = -1.0F;
    }
  }
  std::vector<float> squares;
  squares.reserve(residuals_.size());
  for (const Residual& r : residuals_) {
    if (r.squared >= 0.0F) {
      squares.push_back(r.squared);
    }
  }
  scale_ = kernelScale(squares, kPointDeviations, std::max(kSmallestScale * spacing_, width_));
  scale_ = std::max(scale_, std::sqrt(static_cast<double>(std::numeric_limits<float>::min())));
}

void CloudMatching::accumulate(const SE3& pose, std::size_t i, ResidualRows& rows, NormalEquations& sums) const
{
  const Residual& r = residuals_[i];
  const auto squared = static_cast<double>(r.squared);
  const RobustKernel kernel = isRobust() ? run_.kernel : RobustKernel::none;
  const double robust = robustWeight(kernel, squared, scale_);
  const Eigen::Vector3d arm = pose.rotation * source_.tree.points()[i].cast<double>();
  rows.add(r.m.cast<double>(), r.difference.cast<double>(), arm, robust, 0.0);
  const double weight = robust * static_cast<double>(r.m.trace());
  sums.cost += 0.5 * robustCost(kernel, squared, scale_);
  sums.weighted_squares += robust * squared;
  sums.weight += weight;
  sums.squared_extent += weight * arm.squaredNorm();
  const ShapeKind kind = target_.shapes[static_cast<std::size_t>(match_[i])].kind;
  sums.edges += kind == ShapeKind::line ? 1 : 0;
  sums.planes += kind == ShapeKind::plane ? 1 : 0;
  sums.points += kind == ShapeKind::point ? 1 : 0;
  sums.edge_inliers += kind == ShapeKind::line && robust >= 0.5 ? 1 : 0;
  sums.plane_inliers += kind == ShapeKind::plane && robust >= 0.5 ? 1 : 0;
}

NormalEquations CloudMatching::sum(const SE3& pose) const
{
  return sumOfChunks(residuals_.size(), kResidualsPerChunk, run_.threads, [&](std::size_t first, std::size_t last) {
    NormalEquations sums;
    ResidualRows rows;
    for (std::size_t i = first; i < last; ++i) {
      if (residuals_[i].squared >= 0.0F) {
        accumulate(pose, i, rows, sums);
      }
    }
    rows.addTo(sums);
    return sums;
  });
}

}  // namespace pcl_floam
