// Smoothness weights (Eq. 9).
#include "registration/correspondences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace pcl_floam::test {
namespace {

std::vector<Feature> features(const std::vector<float>& smoothness)
{
  std::vector<Feature> result(smoothness.size());
  for (std::size_t i = 0; i < smoothness.size(); ++i) {
    result[i].smoothness = smoothness[i];
  }
  return result;
}

double sum(const std::vector<double>& weights)
{
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

const std::vector<float> kSmoothness = {0.01F, 0.3F, 1.7F, 0.05F};

TEST(Weights, EachKindSumsToOneAsEquation9)
{
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    EXPECT_NEAR(sum(smoothnessWeights(features(kSmoothness), kind, WeightScheme::printed)), 1.0, 1e-12);
  }
}

TEST(Weights, ElseEachFeatureHasItsSayHoweverManyThereAre)
{
  const auto each = [](const std::vector<float>& smoothness, FeatureKind kind, WeightScheme scheme) {
    return sum(smoothnessWeights(features(smoothness), kind, scheme)) / static_cast<double>(smoothness.size());
  };
  for (const WeightScheme scheme : {WeightScheme::uniform, WeightScheme::inverted}) {
    const double edge = each(kSmoothness, FeatureKind::edge, scheme);
    for (const std::vector<float>& few : {std::vector<float>{0.2F}, {0.3F, 0.3F}, {0.9F, 0.1F, 0.4F}}) {
      EXPECT_NEAR(each(few, FeatureKind::plane, scheme), 1.0, 1e-12) << "residuals keep their units";
      EXPECT_NEAR(each(few, FeatureKind::edge, scheme), edge, 1e-12);
    }
  }
}

/// Edges are seen by few points: they say something, but no edge says as much as a plane.
TEST(Weights, EdgesCountLessThanPlanes)
{
  for (const WeightScheme scheme : {WeightScheme::uniform, WeightScheme::inverted}) {
    const double edges = sum(smoothnessWeights(features(kSmoothness), FeatureKind::edge, scheme));
    EXPECT_GT(edges, 0.0);
    EXPECT_LT(edges, 0.5 * sum(smoothnessWeights(features(kSmoothness), FeatureKind::plane, scheme)));
  }
}

TEST(Weights, PrintedFormIsEquation9)
{
  const auto edges = smoothnessWeights(features(kSmoothness), FeatureKind::edge, WeightScheme::printed);
  const auto planes = smoothnessWeights(features(kSmoothness), FeatureKind::plane, WeightScheme::printed);
  for (std::size_t i = 1; i < kSmoothness.size(); ++i) {
    const double step = kSmoothness[i] - kSmoothness[0];
    EXPECT_NEAR(edges[i] / edges[0], std::exp(-step), 1e-6);
    EXPECT_NEAR(planes[i] / planes[0], std::exp(step), 1e-6);
  }
}

TEST(Weights, InvertedFormFavoursSharpEdgesAndFlatPlanes)
{
  const auto edges = smoothnessWeights(features({0.2F, 0.9F}), FeatureKind::edge, WeightScheme::inverted);
  EXPECT_NEAR(edges[1] / edges[0], std::exp(0.7), 1e-6);
  const auto planes = smoothnessWeights(features({0.2F, 0.9F}), FeatureKind::plane, WeightScheme::inverted);
  EXPECT_NEAR(planes[1] / planes[0], std::exp(-0.7), 1e-6);
}

TEST(Weights, UniformOnesAreAllAlike)
{
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    const auto weights = smoothnessWeights(features(kSmoothness), kind, WeightScheme::uniform);
    for (const double weight : weights) {
      EXPECT_DOUBLE_EQ(weight, weights[0]);
    }
  }
}

TEST(Weights, AFarOutlierDoesNotOverflow)
{
  const auto weights = smoothnessWeights(features({0.1F, 2000.0F}), FeatureKind::plane, WeightScheme::printed);
  EXPECT_NEAR(weights[1], 1.0, 1e-12);
  EXPECT_NEAR(weights[0], 0.0, 1e-12);
}

TEST(Weights, NoFeaturesNoWeights)
{
  EXPECT_TRUE(smoothnessWeights({}, FeatureKind::edge, WeightScheme::printed).empty());
}

}  // namespace
}  // namespace pcl_floam::test
