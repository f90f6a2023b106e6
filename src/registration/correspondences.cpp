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

/// The features whose neighbours are searched at one time.
class Batch {
public:
  void begin() { count_ = 0; }

  void ask(std::size_t feature, const Eigen::Vector3d& query)
  {
    feature_[count_] = feature;
    query_[count_] = query;
    ++count_;
  }

  /// Links the features asked for to what is found around them.
  void link(const FeatureKindProblem& kind, double search_radius, std::vector<Correspondence>& correspondences)
  {
    kind.search.nearestOfEach(query_.data(), count_, kFitNeighbors, search_radius, found_.data());
    for (std::size_t n = 0; n < count_; ++n) {
      Correspondence& correspondence = correspondences[feature_[n]];
      correspondence.weight = 0.0;
      correspondence.searched_at = correspondence.point;
      const auto fit = found_[n].count < kFitNeighbors ? std::nullopt : kind.fit(found_[n]);
      if (fit) {
        correspondence.factor = *fit;
        correspondence.factor.center += correspondence.point;
        correspondence.weight = kind.weights[feature_[n]];
      }
    }
  }

  static constexpr std::size_t kMost = 16;

private:
  std::size_t count_ = 0;
  std::array<std::size_t, kMost> feature_{};
  std::array<Eigen::Vector3d, kMost> query_;
  std::array<Neighbors, kMost> found_;
};

void findOfOneKind(const RegistrationProblem& problem, const FeatureKindProblem& kind,
                   const SweepTrajectory& trajectory, double search_radius, std::size_t stride,
                   std::vector<Correspondence>& correspondences)
{
  correspondences.resize(kind.features.size());
  const double negligible = kNegligible * search_radius;
  const std::size_t looked_at = (kind.features.size() + stride - 1) / stride;
  const auto batches = static_cast<std::ptrdiff_t>((looked_at + Batch::kMost - 1) / Batch::kMost);
#pragma omp parallel num_threads(problem.threads)
  {
    Batch batch;
    // Each feature writes its own element only: the result does not depend on who computes what.
#pragma omp for schedule(dynamic, 4)
    for (std::ptrdiff_t b = 0; b < batches; ++b) {
      const std::size_t first = static_cast<std::size_t>(b) * Batch::kMost;
      const std::size_t last = std::min(first + Batch::kMost, looked_at);
      std::array<Eigen::Vector3d, Batch::kMost> places;
      trajectory.undistorted(&kind.features[first * stride], stride, last - first, places.data());
      batch.begin();
      for (std::size_t n = first; n < last; ++n) {
        Correspondence& correspondence = correspondences[n * stride];
        correspondence.point = trajectory.pose() * places[n - first];
        correspondence.since_reference = trajectory.sinceReference(static_cast<double>(kind.features[n * stride].time));
        if (!((correspondence.point - correspondence.searched_at).squaredNorm() < negligible * negligible)) {
          batch.ask(n * stride, problem.origin + correspondence.point);
        }
      }
      batch.link(kind, search_radius, correspondences);
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
