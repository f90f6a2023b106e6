#include "filters/line_neighborhood.h"

#include "common/median.h"
#include "common/pi.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Angle between neighbours, seen from the sensor, from which a line is sparse, rad: 0.43 degrees. Lidars have 0.1 to
/// 0.4 unless they turn fast. Five neighbours of a sparse line reach around corners, and what lies along it says
/// little.
constexpr float kSparse = 0.0075F;
/// So far, in rad, the neighbours of a sparse line reach on each side.
constexpr float kReach = 0.05F;
constexpr int kFewestNeighbors = 2;

/// Median angle between neighbours, rad.
float medianSpacing(const LinePoints& line, std::vector<float>& sample)
{
  constexpr std::size_t kSample = 128;  // enough for a median, and cheap
  const std::size_t steps = line.x.empty() ? 0 : line.x.size() - 1;
  const std::size_t stride = std::max<std::size_t>(1, steps / kSample);
  sample.clear();
  for (std::size_t n = 0; n < steps; n += stride) {
    const float depth = line.range[n + 1] - line.range[n];
    const float ranges = line.range[n + 1] * line.range[n];
    const float squared = (line.squared_step[n] - depth * depth) / ranges;
    if (std::isfinite(squared)) {
      sample.push_back(squared);
    }
  }
  return std::sqrt(std::max(0.0F, medianOf(sample)));
}

}  // namespace

LineNeighborhood neighborhoodIn(const LinePoints& line, int wanted, std::vector<float>& scratch)
{
  LineNeighborhood neighborhood;
  neighborhood.each_side = wanted;
  neighborhood.spacing = medianSpacing(line, scratch);
  const auto full_circle = static_cast<float>(2.0 * kPi);
  if (static_cast<float>(line.size()) * kSparse <= full_circle && neighborhood.spacing > kSparse) {
    neighborhood.is_sparse = true;
    neighborhood.each_side =
        std::clamp(static_cast<int>(kReach / neighborhood.spacing), std::min(kFewestNeighbors, wanted), wanted);
  }
  return neighborhood;
}

}  // namespace pcl_floam
