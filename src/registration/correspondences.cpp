#include "registration/correspondences.h"

#include "registration/line_plane_fit.h"

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

template <typename Factor, typename Fit>
void findOfOneKind(const RegistrationProblem& problem, const std::vector<Feature>& features,
                   const std::vector<double>& weights, const NeighborSearch& search, int neighbor_count,
                   const SE3& local_T_sensor, double search_radius, Fit&& fit,
                   std::vector<Correspondence<Factor>>& correspondences)
{
  correspondences.resize(features.size());
  // Each iteration writes its own element only: the result does not depend on who computes what.
#pragma omp parallel for num_threads(problem.threads) schedule(dynamic, 64)
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(features.size()); ++i) {
    const Feature& feature = features[static_cast<std::size_t>(i)];
    Correspondence<Factor>& correspondence = correspondences[static_cast<std::size_t>(i)];
    correspondence.weight = 0.0;
    correspondence.point = Eigen::Vector3d(feature.x, feature.y, feature.z);
    const Eigen::Vector3d local = local_T_sensor * correspondence.point;
    Neighbors neighbors;
    search.nearest(problem.origin + local, neighbor_count, search_radius, neighbors);
    if (neighbors.count < neighbor_count) {
      continue;
    }
    if (const auto geometry = fit(neighbors, problem.parameters)) {
      correspondence.factor = makeFactor(*geometry, local);
      correspondence.weight = weights[static_cast<std::size_t>(i)];
      correspondence.response = 1.0 + problem.response_slope * (feature.time - problem.reference);
    }
  }
}

}  // namespace

void findCorrespondences(const RegistrationProblem& problem, const FeatureSet& source,
                         const std::vector<double>& edge_weights, const std::vector<double>& plane_weights,
                         const SE3& local_T_sensor, double search_radius, Correspondences& correspondences)
{
  findOfOneKind(problem, source.edges, edge_weights, *problem.target.edges, problem.parameters.edge_neighbors,
                local_T_sensor, search_radius, fitLine, correspondences.edges);
  findOfOneKind(problem, source.planes, plane_weights, *problem.target.planes, problem.parameters.plane_neighbors,
                local_T_sensor, search_radius, fitPlane, correspondences.planes);
}

}  // namespace pcl_floam
