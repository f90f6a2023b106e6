#include "filters/line_points.h"

#include "common/median.h"
#include "common/multi_version.h"
#include "common/pi.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

PCL_FLOAM_MULTI_VERSION
void computeRanges(std::size_t count, const float* x, const float* y, const float* z, float* range)
{
  for (std::size_t n = 0; n < count; ++n) {
    range[n] = std::sqrt(x[n] * x[n] + y[n] * y[n] + z[n] * z[n]);
  }
}

PCL_FLOAM_MULTI_VERSION
void computeSquaredSteps(std::size_t count, const float* x, const float* y, const float* z, float* squared_step)
{
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const float dx = x[n + 1] - x[n];
    const float dy = y[n + 1] - y[n];
    const float dz = z[n + 1] - z[n];
    squared_step[n] = dx * dx + dy * dy + dz * dz;
  }
}

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

void LinePoints::gather(const CloudView& cloud, const ScanLines& lines, std::size_t m)
{
  const auto first = static_cast<std::size_t>(lines.begin[m]);
  const auto count = static_cast<std::size_t>(lines.begin[m + 1]) - first;
  x.resize(count);
  y.resize(count);
  z.resize(count);
  const std::int32_t* index = lines.index.data() + first;
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(index[n]);
    x[n] = cloud.x(i);
    y[n] = cloud.y(i);
    z[n] = cloud.z(i);
  }
  measure();
}

void LinePoints::measure()
{
  range.resize(x.size());
  squared_step.resize(x.size());
  computeRanges(x.size(), x.data(), y.data(), z.data(), range.data());
  computeSquaredSteps(x.size(), x.data(), y.data(), z.data(), squared_step.data());
  if (!squared_step.empty()) {
    squared_step.back() = 0.0F;
  }
}

LineNeighborhood neighborhoodIn(const LinePoints& line, int wanted, std::vector<float>& scratch)
{
  LineNeighborhood neighborhood;
  neighborhood.each_side = wanted;
  neighborhood.spacing = medianSpacing(line, scratch);
  if (static_cast<float>(line.size()) * kSparse <= static_cast<float>(kTwoPi) && neighborhood.spacing > kSparse) {
    neighborhood.is_sparse = true;
    neighborhood.each_side =
        std::clamp(static_cast<int>(kReach / neighborhood.spacing), std::min(kFewestNeighbors, wanted), wanted);
  }
  return neighborhood;
}

}  // namespace pcl_floam
