#include "registration/weights.h"

#include "common/median.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

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

}  // namespace pcl_floam
