#include "registration/correspondences.h"

#include "common/median.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace pcl_floam {

namespace {

/// A point that has moved by less than this part of the search radius keeps what it was linked to.
constexpr double kNegligible = 0.02;

/// The sign of sigma in the exponent.
double exponentSign(FeatureKind kind, WeightScheme scheme)
{
  if (scheme == WeightScheme::uniform) {
    return 0.0;
  }
  const double as_printed = kind == FeatureKind::edge ? -1.0 : 1.0;
  return scheme == WeightScheme::printed ? as_printed : -as_printed;
}

double medianVariance(const std::vector<Correspondence>& planes)
{
  std::vector<double> variances;
  variances.reserve(planes.size());
  for (const auto& plane : planes) {
    if (plane.weight > 0.0) {
      variances.push_back(plane.factor.variance);
    }
  }
  return medianOf(variances);
}

/// Features of one kind, and how the map holds them.
struct FeatureKindProblem {
  const std::vector<Feature>& features;
  const std::vector<double>& weights;
  const NeighborSearch& search;
  std::optional<Factor> (*fit)(const Neighbors&);
};

/// Links a feature to what was found around it.
void link(const FeatureKindProblem& kind, const Neighbors& found, double weight, Correspondence& correspondence)
{
  correspondence.weight = 0.0;
  correspondence.searched_at = correspondence.point;
  const auto fit = found.count < kFitNeighbors ? std::nullopt : kind.fit(found);
  if (fit) {
    correspondence.factor = *fit;
    correspondence.factor.center += correspondence.point;
    correspondence.weight = weight;
  }
}

void findOfOneKind(const RegistrationProblem& problem, const FeatureKindProblem& kind,
                   const SweepTrajectory& trajectory, double search_radius, std::size_t stride,
                   std::vector<Correspondence>& correspondences)
{
  correspondences.resize(kind.features.size());
  constexpr std::size_t kSearchedAtOnce = 16;
  const double negligible = kNegligible * search_radius;
  const std::size_t looked_at = (kind.features.size() + stride - 1) / stride;
#pragma omp parallel num_threads(problem.threads)
  {
    std::array<std::size_t, kSearchedAtOnce> asked;  // those whose neighbours are searched
    std::array<Eigen::Vector3d, kSearchedAtOnce> queries;
    std::array<Neighbors, kSearchedAtOnce> found;
    // Each feature writes its own element only: the result does not depend on who computes what.
#pragma omp for schedule(dynamic, 4)
    for (std::size_t first = 0; first < looked_at; first += kSearchedAtOnce) {
      std::size_t count = 0;
      const auto ask = [&](std::size_t n, const Eigen::Vector3d& place) {
        const std::size_t feature = (first + n) * stride;
        Correspondence& correspondence = correspondences[feature];
        correspondence.point = trajectory.pose() * place;
        correspondence.since_reference = trajectory.sinceReference(static_cast<double>(kind.features[feature].time));
        if (!((correspondence.point - correspondence.searched_at).squaredNorm() < negligible * negligible)) {
          queries[count] = problem.origin + correspondence.point;
          asked[count++] = feature;
        }
      };
      trajectory.undistorted(&kind.features[first * stride], stride, std::min(kSearchedAtOnce, looked_at - first), ask);
      kind.search.nearestOfEach(queries.data(), count, kFitNeighbors, search_radius, found.data());
      for (std::size_t n = 0; n < count; ++n) {
        link(kind, found[n], kind.weights[asked[n]], correspondences[asked[n]]);
      }
    }
  }
}

}  // namespace

std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind, WeightScheme scheme)
{
  const double sign = exponentSign(kind, scheme);
  double largest = 0.0;  // exponents are taken relative to it: one far outlier's exp must not overflow
  for (const Feature& feature : features) {
    largest = std::max(largest, sign * feature.smoothness);
  }
  std::vector<double> weights(features.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    weights[i] = std::exp(sign * features[i].smoothness - largest);
    sum += weights[i];
  }
  const double each = kind == FeatureKind::edge ? kEdgeWeight : 1.0;
  const double total = scheme == WeightScheme::printed ? 1.0 : each * static_cast<double>(features.size());
  for (double& weight : weights) {
    weight *= total / sum;
  }
  return weights;
}

void weighByScatter(const std::vector<double>& weights, std::vector<Correspondence>& planes)
{
  constexpr double kLeastVariance = 1e-6;  // m^2: no map is better than to a millimetre
  const double half = kPlaneScatter * kPlaneScatter * std::max(kLeastVariance, medianVariance(planes));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].weight > 0.0) {
      planes[i].weight = weights[i] * half / (half + planes[i].factor.variance);
    }
  }
}

void findCorrespondences(const RegistrationProblem& problem, const FeatureSet& source,
                         const std::vector<double>& edge_weights, const std::vector<double>& plane_weights,
                         const SweepTrajectory& trajectory, double search_radius, std::size_t stride,
                         Correspondences& correspondences)
{
  const FeatureKindProblem edges{source.edges, edge_weights, *problem.target.edges, fitLine};
  const FeatureKindProblem planes{source.planes, plane_weights, *problem.target.planes, fitPlane};
  findOfOneKind(problem, edges, trajectory, search_radius, stride, correspondences.edges);
  findOfOneKind(problem, planes, trajectory, search_radius, stride, correspondences.planes);
  weighByScatter(plane_weights, correspondences.planes);
}

}  // namespace pcl_floam
