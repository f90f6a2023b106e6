#include "registration/normal_equations.h"

#include "registration/residual_rows.h"
#include "registration/robust_kernel.h"

#include <algorithm>
#include <vector>

namespace pcl_floam {

namespace {

/// As many as have room for their rows.
constexpr std::size_t kFeaturesPerChunk = ResidualRows::kRoom / 2;

/// Of a chunk's linked planes, every so many-th tells of the tilts' noise for all: it is a mean over hundreds that is
/// wanted.
constexpr int kNoiseStride = 4;

/// Residuals of three standard deviations are left almost untouched by the kernel.
constexpr double kFeatureDeviations = 3.0;

/// The kernel's scale for residuals of one kind, m.
double scaleOf(const std::vector<Correspondence>& correspondences)
{
  std::vector<double> squares;
  squares.reserve(correspondences.size());
  for (const Correspondence& c : correspondences) {
    if (c.weight > 0.0) {
      squares.push_back(c.factor.residual(c.point).squaredNorm());
    }
  }
  return kernelScale(squares, kFeatureDeviations, kSmallestKernelScale);
}

/// The sums of one chunk.
class ChunkSums {
public:
  void add(const Correspondence& c, RobustKernel kernel, double scale)
  {
    if (c.weight <= 0.0) {
      return;
    }
    const bool is_plane = c.factor.kind == FeatureKind::plane;
    const double squared = c.factor.residual(c.point).squaredNorm();
    const double robust = robustWeight(kernel, squared, scale);
    const double weight = c.weight * robust;
    for (int i = 0; i < c.factor.directions(); ++i) {
      const Eigen::Vector3d held = c.factor.heldDirection(i);
      rows_.add(held, c.point, held.dot(c.point - c.factor.center), weight, c.since_reference);
    }
    if (is_plane && sums_.planes % kNoiseStride == 0) {  // edges are few and face all ways
      for (const Eigen::Vector3d& tilt : c.factor.tilt) {
        noise_.add(tilt, c.point, 0.0, kNoiseStride * weight, 0.0);
      }
    }
    sums_.cost += 0.5 * c.weight * robustCost(kernel, squared, scale);
    sums_.weighted_squares += weight * squared;
    sums_.weight += weight;
    sums_.given_weight += c.weight;
    sums_.squared_extent += weight * c.point.squaredNorm();
    ++(is_plane ? sums_.planes : sums_.edges);
    (is_plane ? sums_.plane_inliers : sums_.edge_inliers) += robust >= 0.5 ? 1 : 0;
  }

  [[nodiscard]] NormalEquations sums()
  {
    NormalEquations noise;
    noise_.addTo(noise);
    sums_.noise_information = noise.information;
    rows_.addTo(sums_);
    return sums_;
  }

private:
  NormalEquations sums_;
  ResidualRows rows_;
  ResidualRows noise_;  ///< what normals that are off add to H
};

}  // namespace

KernelScales adaptKernelScales(const Correspondences& correspondences)
{
  return {scaleOf(correspondences.edges), scaleOf(correspondences.planes)};
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other)
{
  information += other.information;
  noise_information += other.noise_information;
  coupling += other.coupling;
  twist_information += other.twist_information;
  gradient += other.gradient;
  twist_gradient += other.twist_gradient;
  cost += other.cost;
  weighted_squares += other.weighted_squares;
  weight += other.weight;
  given_weight += other.given_weight;
  squared_extent += other.squared_extent;
  edges += other.edges;
  planes += other.planes;
  points += other.points;
  edge_inliers += other.edge_inliers;
  plane_inliers += other.plane_inliers;
  return *this;
}

NormalEquations sumOfChunks(std::size_t count, std::size_t per_chunk, int threads,
                            const std::function<NormalEquations(std::size_t first, std::size_t last)>& sumsOf)
{
  std::vector<NormalEquations> chunks((count + per_chunk - 1) / per_chunk);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t n = 0; n < chunks.size(); ++n) {
    chunks[n] = sumsOf(n * per_chunk, std::min((n + 1) * per_chunk, count));
  }
  NormalEquations result;
  for (const NormalEquations& sums : chunks) {
    result += sums;
  }
  return result;
}

NormalEquations buildNormalEquations(const RegistrationProblem& problem, const Correspondences& correspondences,
                                     const KernelScales& scales)
{
  const std::size_t edges = correspondences.edges.size();
  const RobustKernel kernel = problem.parameters.kernel;
  return sumOfChunks(edges + correspondences.planes.size(), kFeaturesPerChunk, problem.threads,
                     [&](std::size_t first, std::size_t last) {
                       ChunkSums sums;
                       for (std::size_t i = first; i < last; ++i) {
                         const bool is_edge = i < edges;
                         sums.add(is_edge ? correspondences.edges[i] : correspondences.planes[i - edges], kernel,
                                  is_edge ? scales.edge : scales.plane);
                       }
                       return sums.sums();
                     });
}

NormalEquations reducedToPose(const NormalEquations& equations, const SweepModel& model)
{
  NormalEquations reduced = equations;
  if (model.follows_pose) {
    const double slope = model.sweep_per_motion;
    reduced.information += 2.0 * slope * equations.coupling + slope * slope * equations.twist_information;
    // Roughly: the normals' noise grows with the whole, not with the points before and after the reference apart.
    reduced.noise_information *= reduced.information.trace() / equations.information.trace();
    reduced.gradient += slope * equations.twist_gradient;
  }
  return reduced;
}

}  // namespace pcl_floam
