// LevelAlignment: what its matches say of the pose.
#include "common/median.h"
#include "registration/level_alignment.h"
#include "registration/robust_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

constexpr std::size_t kResidualsPerChunk = 512;

/// For normally distributed residuals, 1.4826 medians of the absolute value are one standard deviation.
constexpr double kPointScalePerMedian = 2.0 * 1.4826;
constexpr double kSmallestScale = 1e-4;  ///< of the kernel, in spacings

}  // namespace

AlignmentSums& AlignmentSums::operator+=(const AlignmentSums& other)
{
  information += other.information;
  gradient += other.gradient;
  cost += other.cost;
  weighted_squares += other.weighted_squares;
  weight += other.weight;
  lines += other.lines;
  planes += other.planes;
  points += other.points;
  line_inliers += other.line_inliers;
  plane_inliers += other.plane_inliers;
  return *this;
}

LevelAlignment::Residual LevelAlignment::residual(const SE3& pose, std::size_t i) const
{
  const auto j = static_cast<std::size_t>(match_[i]);
  LocalShape turned = source_.shapes[i];
  turned.axis = (pose.rotation * turned.axis.cast<double>()).cast<float>();
  const Eigen::Matrix3d c = target_.shapes[j].covariance(along_) + turned.covariance(along_);
  const auto onSurface = [](const CloudLevel& level, std::size_t point) {
    return Eigen::Vector3d((level.tree.points()[point] + level.shapes[point].to_surface).cast<double>());
  };
  const Eigen::Vector3d difference = pose * onSurface(source_, i) - onSurface(target_, j);
  // M = 2 along_ c^-1: one across two parallel planes.
  const double xx = c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2);
  const double xy = c(0, 2) * c(1, 2) - c(0, 1) * c(2, 2);
  const double xz = c(0, 1) * c(1, 2) - c(0, 2) * c(1, 1);
  const double scale = 2.0 * along_ / (c(0, 0) * xx + c(0, 1) * xy + c(0, 2) * xz);
  Eigen::Matrix3d m;
  m(0, 0) = scale * xx;
  m(0, 1) = m(1, 0) = scale * xy;
  m(0, 2) = m(2, 0) = scale * xz;
  m(1, 1) = scale * (c(0, 0) * c(2, 2) - c(0, 2) * c(0, 2));
  m(1, 2) = m(2, 1) = scale * (c(0, 1) * c(0, 2) - c(0, 0) * c(1, 2));
  m(2, 2) = scale * (c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1));
  const auto f = [](double value) { return static_cast<float>(value); };
  return {difference.cast<float>(),
          f(m(0, 0)),
          f(m(0, 1)),
          f(m(0, 2)),
          f(m(1, 1)),
          f(m(1, 2)),
          f(m(2, 2)),
          f(std::max(0.0, difference.dot(m * difference)))};
}

void LevelAlignment::weigh(const SE3& pose)
{
#pragma omp parallel for num_threads(run_.threads) schedule(static)
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(match_.size()); ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (match_[i] >= 0) {
      residuals_[i] = residual(pose, i);
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
  scale_ =
      std::max(kSmallestScale * spacing_, kPointScalePerMedian * std::sqrt(static_cast<double>(medianOf(squares))));
  scale_ = std::max(scale_, width_);
  scale_ = std::max(scale_, std::sqrt(static_cast<double>(std::numeric_limits<float>::min())));
}

void LevelAlignment::accumulate(const SE3& pose, std::size_t i, AlignmentSums& sums) const
{
  const Residual& r = residuals_[i];
  const auto squared = static_cast<double>(r.squared);
  const RobustKernel kernel = robust_ ? run_.kernel : RobustKernel::none;
  const double robust = robustWeight(kernel, squared, scale_);
  Eigen::Matrix3f symmetric;
  symmetric << r.xx, r.xy, r.xz, r.xy, r.yy, r.yz, r.xz, r.yz, r.zz;
  const Eigen::Matrix3d m = robust * symmetric.cast<double>();
  const Eigen::Vector3d arm = pose.rotation * source_.tree.points()[i].cast<double>();
  // J = [I, -[arm]x]: with m's columns, m J = [m, -m [arm]x] = [m, (arm x m)^T].
  Eigen::Matrix3d turned;
  for (int column = 0; column < 3; ++column) {
    turned.col(column) = arm.cross(m.col(column));
  }
  const Eigen::Vector3d pull = m * r.difference.cast<double>();
  sums.information.topLeftCorner<3, 3>() += m;
  sums.information.bottomLeftCorner<3, 3>() += turned;
  for (int row = 0; row < 3; ++row) {
    sums.information.bottomRightCorner<3, 3>().row(row) += arm.cross(turned.row(row).transpose()).transpose();
  }
  sums.gradient.head<3>() += pull;
  sums.gradient.tail<3>() += arm.cross(pull);
  sums.cost += 0.5 * robustCost(kernel, squared, scale_);
  sums.weighted_squares += robust * squared;
  sums.weight += m.trace();
  const ShapeKind kind = target_.shapes[static_cast<std::size_t>(match_[i])].kind;
  sums.lines += kind == ShapeKind::line ? 1 : 0;
  sums.planes += kind == ShapeKind::plane ? 1 : 0;
  sums.points += kind == ShapeKind::point ? 1 : 0;
  sums.line_inliers += kind == ShapeKind::line && robust >= 0.5 ? 1 : 0;
  sums.plane_inliers += kind == ShapeKind::plane && robust >= 0.5 ? 1 : 0;
}

AlignmentSums LevelAlignment::sum(const SE3& pose) const
{
  std::vector<AlignmentSums> chunks((residuals_.size() + kResidualsPerChunk - 1) / kResidualsPerChunk);
#pragma omp parallel for num_threads(run_.threads) schedule(static)
  for (std::ptrdiff_t chunk = 0; chunk < static_cast<std::ptrdiff_t>(chunks.size()); ++chunk) {
    const std::size_t first = static_cast<std::size_t>(chunk) * kResidualsPerChunk;
    for (std::size_t i = first; i < std::min(first + kResidualsPerChunk, residuals_.size()); ++i) {
      if (residuals_[i].squared >= 0.0F) {
        accumulate(pose, i, chunks[static_cast<std::size_t>(chunk)]);
      }
    }
  }
  AlignmentSums result;
  for (const AlignmentSums& sums : chunks) {
    result += sums;
  }
  result.information.topRightCorner<3, 3>() = result.information.bottomLeftCorner<3, 3>().transpose();
  return result;
}

}  // namespace pcl_floam
