#include "registration/feature_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pcl_floam {

namespace {

/// 21 bits of a cell's number along one axis.
std::uint64_t cellNumber(float coordinate, float cell)
{
  constexpr float kHalf = 1 << 20;
  if (std::isnan(coordinate)) {
    return 0;
  }
  return static_cast<std::uint64_t>(std::clamp(std::floor(coordinate / cell), -kHalf, kHalf - 1.0F) + kHalf);
}

}  // namespace

std::vector<Feature> evenly(const std::vector<Feature>& features, std::size_t most)
{
  const std::size_t count = std::min(most, features.size());
  std::vector<Feature> taken(count);
  for (std::size_t i = 0; i < count; ++i) {
    taken[i] = features[i * features.size() / count];
  }
  return taken;
}

std::vector<Feature> atMostPerCell(const std::vector<Feature>& features, float cell, int most_per_cell)
{
  std::unordered_map<std::uint64_t, int> taken;
  taken.reserve(features.size());
  std::vector<Feature> result;
  for (const Feature& f : features) {
    if (taken[cellNumber(f.x, cell) << 42 | cellNumber(f.y, cell) << 21 | cellNumber(f.z, cell)]++ < most_per_cell) {
      result.push_back(f);
    }
  }
  return result;
}

}  // namespace pcl_floam
