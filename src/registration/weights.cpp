#include "registration/weights.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind, WeightScheme scheme,
                                      WeightNormalization normalization)
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
  const double total = normalization == WeightNormalization::sum_one ? 1.0 : static_cast<double>(features.size());
  for (double& weight : weights) {
    weight *= total / sum;
  }
  return weights;
}

}  // namespace pcl_floam
