#include "registration/feature_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

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

/// How often each cell was met: open addressing, since the standard library's map is slower by what shows in the whole.
class CellCounts {
public:
  explicit CellCounts(std::size_t most)
  {
    while (counts_.size() < 2 * most + 1) {
      counts_.resize(std::max<std::size_t>(64, 2 * counts_.size()));
    }
  }

  /// \return how often, with this time
  int add(std::uint64_t cell)
  {
    const std::size_t mask = counts_.size() - 1;
    std::size_t place = static_cast<std::size_t>(cell * 0x9E3779B97F4A7C15ULL >> 32) & mask;
    while (counts_[place].count > 0 && counts_[place].cell != cell) {
      place = (place + 1) & mask;
    }
    counts_[place].cell = cell;
    return ++counts_[place].count;
  }

private:
  struct Count {
    std::uint64_t cell = 0;
    int count = 0;
  };
  std::vector<Count> counts_;  ///< a power of two
};

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
  CellCounts counts(features.size());
  std::vector<Feature> result;
  result.reserve(features.size());
  for (const Feature& f : features) {
    if (counts.add(cellNumber(f.x, cell) << 42 | cellNumber(f.y, cell) << 21 | cellNumber(f.z, cell)) <=
        most_per_cell) {
      result.push_back(f);
    }
  }
  return result;
}

FeatureSet spreadSample(const FeatureSet& features)
{
  constexpr std::size_t kEnough = 500;
  FeatureSet sample;
  for (const float cell : {2.0F, 1.0F, 0.5F, 0.25F}) {  // m
    sample = {atMostPerCell(features.edges, cell, 1), atMostPerCell(features.planes, cell, 1)};
    if (sample.edges.size() + sample.planes.size() >= kEnough) {
      return sample;
    }
  }
  return features;
}

}  // namespace pcl_floam
