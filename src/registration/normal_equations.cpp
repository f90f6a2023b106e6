#include "registration/normal_equations.h"

#include "common/median.h"
#include "registration/robust_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pcl_floam {

namespace {

constexpr std::size_t kFeaturesPerChunk = 256;

/// Of a chunk's linked planes, every so many-th tells of the tilts' noise for all: it is a mean over hundreds that is
/// wanted.
constexpr std::size_t kNoiseStride = 4;

/// For normally distributed residuals, 1.4826 medians of the absolute value are one standard deviation; three of
/// those are left almost untouched by the kernel.
constexpr double kFeatureScalePerMedian = 3.0 * 1.4826;

/// The kernel's scale for residuals of one kind, m.
template <typename Factor>
double scaleOf(const std::vector<Correspondence<Factor>>& correspondences, double smallest)
{
  std::vector<double> squares;
  squares.reserve(correspondences.size());
  for (const auto& c : correspondences) {
    if (c.weight > 0.0) {
      squares.push_back(c.factor.squaredResidual(c.point));
    }
  }
  return std::max(smallest, kFeatureScalePerMedian * std::sqrt(medianOf(squares)));
}

/// The sums of one chunk: upper triangles, row by row, so that the compiler can keep to straight lines.
class ChunkSums {
public:
  /// One scalar residual r = n^T (q - c), whose derivative by the perturbation is J = n^T [I, -[q]x] (Eq. 11, 13, 14).
  void add(const Eigen::Vector3d& q, const Eigen::Vector3d& n, double residual, double weight, double since_reference)
  {
    const std::array<double, 6> j = derivative(q, n);
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const double wj = weight * j[row];
      const double swj = since_reference * wj;
      const double sswj = since_reference * swj;
      for (std::size_t column = row; column < 6; ++column, ++k) {
        information_[k] += wj * j[column];
        coupling_[k] += swj * j[column];
        twist_information_[k] += sswj * j[column];
      }
      gradient_[row] += wj * residual;
      twist_gradient_[row] += swj * residual;
    }
  }

  /// What a normal that is off by \p tilt adds to H.
  void addNoise(const Eigen::Vector3d& q, const Eigen::Vector3d& tilt, double weight)
  {
    const std::array<double, 6> j = derivative(q, tilt);
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const double wj = weight * j[row];
      for (std::size_t column = row; column < 6; ++column, ++k) {
        noise_information_[k] += wj * j[column];
      }
    }
  }

  void addTo(NormalEquations& sums) const
  {
    std::size_t k = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column, ++k) {
        addSymmetric(information_[k], row, column, sums.information);
        addSymmetric(noise_information_[k], row, column, sums.noise_information);
        addSymmetric(coupling_[k], row, column, sums.coupling);
        addSymmetric(twist_information_[k], row, column, sums.twist_information);
      }
      sums.gradient[row] += gradient_[static_cast<std::size_t>(row)];
      sums.twist_gradient[row] += twist_gradient_[static_cast<std::size_t>(row)];
    }
    sums.cost += scalars.cost;
    sums.weighted_squares += scalars.weighted_squares;
    sums.weight += scalars.weight;
    sums.given_weight += scalars.given_weight;
    sums.squared_extent += scalars.squared_extent;
    sums.edges += scalars.edges;
    sums.planes += scalars.planes;
    sums.edge_inliers += scalars.edge_inliers;
    sums.plane_inliers += scalars.plane_inliers;
  }

  /// The sums that are not by direction.
  struct Scalars {
    double cost = 0.0;
    double weighted_squares = 0.0;
    double weight = 0.0;
    double given_weight = 0.0;
    double squared_extent = 0.0;
    int edges = 0;
    int planes = 0;
    int edge_inliers = 0;
    int plane_inliers = 0;
  } scalars;

private:
  /// n^T [I, -[q]x]
  static std::array<double, 6> derivative(const Eigen::Vector3d& q, const Eigen::Vector3d& n)
  {
    return {n.x(),
            n.y(),
            n.z(),
            q.y() * n.z() - q.z() * n.y(),
            q.z() * n.x() - q.x() * n.z(),
            q.x() * n.y() - q.y() * n.x()};
  }

  static void addSymmetric(double value, int row, int column, Matrix6& matrix)
  {
    matrix(row, column) += value;
    if (row != column) {
      matrix(column, row) += value;
    }
  }

  std::array<double, 21> information_{};
  std::array<double, 21> noise_information_{};
  std::array<double, 21> coupling_{};
  std::array<double, 21> twist_information_{};
  std::array<double, 6> gradient_{};
  std::array<double, 6> twist_gradient_{};
};

void addRows(const Correspondence<PlaneFactor>& c, double weight, ChunkSums& sums)
{
  sums.add(c.point, c.factor.normal, c.factor.residual(c.point)[0], weight, c.since_reference);
}

/// The noise in the rows of a plane.
void addNoise(const Correspondence<PlaneFactor>& c, double weight, int count, ChunkSums& sums)
{
  if (static_cast<std::size_t>(count) % kNoiseStride != 0) {
    return;
  }
  weight *= static_cast<double>(kNoiseStride);
  for (const Eigen::Vector3d& tilt : c.tilt) {
    sums.addNoise(c.point, tilt, weight);
  }
}

/// Edges are few and face all ways: theirs is left out.
void addNoise(const Correspondence<EdgeFactor>& /*c*/, double /*weight*/, int /*count*/, ChunkSums& /*sums*/) {}

/// The residual vector across the line as its two components: the third is zero.
void addRows(const Correspondence<EdgeFactor>& c, double weight, ChunkSums& sums)
{
  const Eigen::Vector3d across = c.factor.direction.unitOrthogonal();
  const Eigen::Vector3d difference = c.point - c.factor.center;
  for (const Eigen::Vector3d& axis : {across, Eigen::Vector3d(c.factor.direction.cross(across))}) {
    sums.add(c.point, axis, axis.dot(difference), weight, c.since_reference);
  }
}

template <typename Factor>
void accumulate(const Correspondence<Factor>& c, RobustKernel kernel, double scale, ChunkSums& sums, int& count,
                int& inliers)
{
  if (c.weight <= 0.0) {
    return;
  }
  const double squared = c.factor.squaredResidual(c.point);
  const double robust = robustWeight(kernel, squared, scale);
  const double weight = c.weight * robust;
  addRows(c, weight, sums);
  addNoise(c, weight, count, sums);
  sums.scalars.cost += 0.5 * c.weight * robustCost(kernel, squared, scale);
  sums.scalars.weighted_squares += weight * squared;
  sums.scalars.weight += weight;
  sums.scalars.given_weight += c.weight;
  sums.scalars.squared_extent += weight * c.point.squaredNorm();
  ++count;
  inliers += robust >= 0.5 ? 1 : 0;
}

}  // namespace

KernelScales adaptKernelScales(const RegistrationProblem& problem, const Correspondences& correspondences)
{
  const double smallest = problem.parameters.kernel_scale;
  return {scaleOf(correspondences.edges, smallest), scaleOf(correspondences.planes, smallest)};
}

NormalEquations buildNormalEquations(const RegistrationProblem& problem, const Correspondences& correspondences,
                                     const KernelScales& scales)
{
  const std::size_t edges = correspondences.edges.size();
  const std::size_t total = edges + correspondences.planes.size();
  std::vector<ChunkSums> chunks((total + kFeaturesPerChunk - 1) / kFeaturesPerChunk);
  const RobustKernel kernel = problem.parameters.kernel;
#pragma omp parallel for num_threads(problem.threads) schedule(static)
  for (std::ptrdiff_t chunk = 0; chunk < static_cast<std::ptrdiff_t>(chunks.size()); ++chunk) {
    ChunkSums& sums = chunks[static_cast<std::size_t>(chunk)];
    auto& counts = sums.scalars;
    const std::size_t first = static_cast<std::size_t>(chunk) * kFeaturesPerChunk;
    for (std::size_t i = first; i < std::min(first + kFeaturesPerChunk, total); ++i) {
      if (i < edges) {
        accumulate(correspondences.edges[i], kernel, scales.edge, sums, counts.edges, counts.edge_inliers);
      } else {
        accumulate(correspondences.planes[i - edges], kernel, scales.plane, sums, counts.planes, counts.plane_inliers);
      }
    }
  }
  NormalEquations result;
  for (const ChunkSums& sums : chunks) {
    sums.addTo(result);
  }
  return result;
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

void lock(const DegreesOfFreedom& locked, NormalEquations& equations)
{
  for (int i = 0; i < 6; ++i) {
    if (locked[static_cast<std::size_t>(i)]) {
      for (Matrix6* matrix :
           {&equations.information, &equations.noise_information, &equations.coupling, &equations.twist_information}) {
        matrix->row(i).setZero();
        matrix->col(i).setZero();
      }
      equations.gradient[i] = 0.0;
      equations.twist_gradient[i] = 0.0;
    }
  }
}

}  // namespace pcl_floam
