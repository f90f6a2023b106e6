#include "registration/correspondences.h"

#include "registration/line_plane_fit.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

EdgeFactor makeFactor(const LineFit& line, const Eigen::Vector3d& query)
{
  return {query + line.center, line.direction};
}

PlaneFactor makeFactor(const PlaneFit& plane, const Eigen::Vector3d& query)
{
  return {query + plane.center, plane.normal};
}

/// A point that has moved by less than this part of the search radius keeps what it was linked to.
constexpr double kNegligible = 0.02;

template <typename Factor, typename Fit>
void findOne(const RegistrationProblem& problem, const NeighborSearch& search, int k, double weight,
             double search_radius, const Fit& fit, Correspondence<Factor>& correspondence)
{
  correspondence.weight = 0.0;
  correspondence.searched_at = correspondence.point;
  Neighbors neighbors;
  search.nearest(problem.origin + correspondence.point, k, search_radius, neighbors);
  if (neighbors.count < k) {
    return;
  }
  if (const auto geometry = fit(neighbors, problem.parameters)) {
    correspondence.factor = makeFactor(*geometry, correspondence.point);
    correspondence.weight = weight;
  }
}

template <typename Factor, typename Fit>
void findOfOneKind(const RegistrationProblem& problem, const std::vector<Feature>& features,
                   const std::vector<double>& weights, const NeighborSearch& search, int k,
                   const SweepTrajectory& trajectory, double search_radius, std::size_t stride, const Fit& fit,
                   std::vector<Correspondence<Factor>>& correspondences)
{
  correspondences.resize(features.size());
  const double negligible = kNegligible * search_radius;
  // Each iteration writes its own element only: the result does not depend on who computes what.
#pragma omp parallel for num_threads(problem.threads) schedule(dynamic, 64)
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(features.size());
       n += static_cast<std::ptrdiff_t>(stride)) {
    const auto i = static_cast<std::size_t>(n);
    const Feature& feature = features[i];
    Correspondence<Factor>& correspondence = correspondences[i];
    correspondence.point = trajectory.at(Eigen::Vector3d(feature.x, feature.y, feature.z), feature.time);
    correspondence.since_reference = trajectory.sinceReference(feature.time);
    if (!((correspondence.point - correspondence.searched_at).squaredNorm() < negligible * negligible)) {
      findOne(problem, search, k, weights[i], search_radius, fit, correspondence);
    }
  }
}

}  // namespace

void findCorrespondences(const RegistrationProblem& problem, const FeatureSet& source,
                         const std::vector<double>& edge_weights, const std::vector<double>& plane_weights,
                         const SweepTrajectory& trajectory, double search_radius, std::size_t stride,
                         Correspondences& correspondences)
{
  findOfOneKind(problem, source.edges, edge_weights, *problem.target.edges, problem.parameters.edge_neighbors,
                trajectory, search_radius, stride, fitLine, correspondences.edges);
  findOfOneKind(problem, source.planes, plane_weights, *problem.target.planes, problem.parameters.plane_neighbors,
                trajectory, search_radius, stride, fitPlane, correspondences.planes);
}

}  // namespace pcl_floam
