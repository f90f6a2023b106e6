#include "registration/normal_equations.h"

#include "registration/motion_model.h"
#include "registration/robust_kernel.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

constexpr std::size_t kChunk = 256;

/// For normally distributed residuals, 1.4826 medians of the absolute value are one standard deviation; three of
/// those are left almost untouched by the kernel.
constexpr double kScalePerMedian = 3.0 * 1.4826;

template <typename Factor>
double medianResidual(const std::vector<Correspondence<Factor>>& correspondences, const SE3& local_T_sensor)
{
  std::vector<double> residuals;
  residuals.reserve(correspondences.size());
  for (const auto& c : correspondences) {
    if (c.weight > 0.0) {
      residuals.push_back(c.factor.residual(local_T_sensor * c.point).norm());
    }
  }
  if (residuals.empty()) {
    return 0.0;
  }
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

template <typename Factor>
void accumulate(const Correspondence<Factor>& c, const SE3& local_T_sensor, RobustKernel kernel, double scale,
                NormalEquations& sums, int& count, int& inliers)
{
  if (c.weight <= 0.0) {
    return;
  }
  const Eigen::Vector3d point = local_T_sensor * c.point;
  const auto residual = c.factor.residual(point);
  const double squared = residual.squaredNorm();
  const double robust = robustWeight(kernel, squared, scale);
  const double weight = c.weight * robust;
  // J = dr/d(Tp) d(Tp)/d(delta) (Eq. 13, 14)
  const Eigen::Matrix<double, Factor::kResiduals, 6> jacobian =
      c.factor.derivative() * RigidMotion::derivative(point, c.response);
  sums.information.noalias() += weight * jacobian.transpose() * jacobian;
  sums.gradient.noalias() += weight * jacobian.transpose() * residual;
  sums.cost += 0.5 * c.weight * robustCost(kernel, squared, scale);
  sums.weighted_squares += weight * squared;
  sums.weight += weight;
  sums.squared_extent += weight * point.squaredNorm();
  ++count;
  inliers += robust >= 0.5 ? 1 : 0;
}

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other)
{
  information += other.information;
  gradient += other.gradient;
  cost += other.cost;
  weighted_squares += other.weighted_squares;
  weight += other.weight;
  squared_extent += other.squared_extent;
  edges += other.edges;
  planes += other.planes;
  edge_inliers += other.edge_inliers;
  plane_inliers += other.plane_inliers;
  return *this;
}

KernelScales adaptKernelScales(const RegistrationProblem& problem, const SE3& local_T_sensor,
                               const Correspondences& correspondences)
{
  const double smallest = problem.parameters.kernel_scale;
  return {std::max(smallest, kScalePerMedian * medianResidual(correspondences.edges, local_T_sensor)),
          std::max(smallest, kScalePerMedian * medianResidual(correspondences.planes, local_T_sensor))};
}

NormalEquations buildNormalEquations(const RegistrationProblem& problem, const SE3& local_T_sensor,
                                     const Correspondences& correspondences, const KernelScales& scales)
{
  const std::size_t edges = correspondences.edges.size();
  const std::size_t total = edges + correspondences.planes.size();
  std::vector<NormalEquations> chunks((total + kChunk - 1) / kChunk);
  const RobustKernel kernel = problem.parameters.kernel;
#pragma omp parallel for num_threads(problem.threads) schedule(static)
  for (std::ptrdiff_t chunk = 0; chunk < static_cast<std::ptrdiff_t>(chunks.size()); ++chunk) {
    NormalEquations& sums = chunks[static_cast<std::size_t>(chunk)];
    const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t i = first; i < std::min(first + kChunk, total); ++i) {
      if (i < edges) {
        accumulate(correspondences.edges[i], local_T_sensor, kernel, scales.edge, sums, sums.edges, sums.edge_inliers);
      } else {
        accumulate(correspondences.planes[i - edges], local_T_sensor, kernel, scales.plane, sums, sums.planes,
                   sums.plane_inliers);
      }
    }
  }
  NormalEquations result;
  for (const NormalEquations& sums : chunks) {
    result += sums;
  }
  return result;
}

}  // namespace pcl_floam
