#include "filters/selectability.h"

#include "common/multi_version.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_floam {

namespace {

/// Points further apart than this, in rad, have no surface between them that one could hide from the other.
constexpr float kAdjacent = 0.05F;
/// Spacing to both neighbours, as a part of the range, from which incidence is called grazing (LOAM's value).
constexpr float kGrazingSpacing = 0.0141F;
/// Where the points of a line are that far apart anyway, so much of the squared spacing must be in depth: incidence of
/// 63 degrees, as kGrazingSpacing has it with beams 0.36 degrees apart.
constexpr float kGrazingDepth = 0.8F;

/// Steps looked at together: most stretches of a line have no depth step at all.
constexpr std::size_t kStretch = 256;

PCL_FLOAM_MULTI_VERSION
void markOutOfRange(std::size_t count, const float* range, float min_range, float max_range, std::int32_t* unfit)
{
  for (std::size_t n = 0; n < count; ++n) {
    unfit[n] = static_cast<std::int32_t>(range[n] < min_range) | static_cast<std::int32_t>(range[n] > max_range);
  }
}

PCL_FLOAM_MULTI_VERSION
void markGrazing(std::size_t count, const float* range, const float* squared_step, std::int32_t* unfit)
{
  for (std::size_t n = 1; n + 1 < count; ++n) {
    const float limit = kGrazingSpacing * kGrazingSpacing * range[n] * range[n];
    unfit[n] |=
        static_cast<std::int32_t>(squared_step[n - 1] > limit) & static_cast<std::int32_t>(squared_step[n] > limit);
  }
}

/// In a sparse line what is not mostly in depth is not grazing.
void markGrazingInDepth(const LinePoints& line, std::vector<std::int32_t>& unfit)
{
  const auto isGrazing = [&line](std::size_t n) {
    const float step = line.range[n + 1] - line.range[n];
    return line.squared_step[n] > kGrazingSpacing * kGrazingSpacing * line.range[n] * line.range[n] &&
           step * step > kGrazingDepth * line.squared_step[n];
  };
  for (std::size_t n = 1; n + 1 < unfit.size(); ++n) {
    unfit[n] |= static_cast<std::int32_t>(isGrazing(n - 1) && isGrazing(n));
  }
}

/// For up to \ref kStretch neighbours in a row: is the step between them one in depth, from one surface to another?
/// \return how many are
PCL_FLOAM_MULTI_VERSION
std::int32_t findDepthSteps(std::size_t count, const float* range, const float* squared_step, std::int32_t* is_step)
{
  std::int32_t steps = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const float here = range[n];
    const float next = range[n + 1];
    const float step = next - here;
    const float nearer = next < here ? next : here;  // std::min would keep the loop from being made one of vectors
    const std::int32_t is_deep = std::abs(step) >= kDepthStep * nearer ? 1 : 0;
    const std::int32_t is_near = squared_step[n] - step * step <= kAdjacent * kAdjacent * nearer * nearer ? 1 : 0;
    is_step[n] = is_deep & is_near;
    steps += is_deep & is_near;
  }
  return steps;
}

/// Marks the \p half_window points on the far side of each depth step.
void markOccluded(const LinePoints& line, std::size_t half_window, std::vector<std::int32_t>& unfit)
{
  const std::size_t steps = line.range.empty() ? 0 : line.range.size() - 1;
  std::array<std::int32_t, kStretch> is_step{};
  for (std::size_t first = 0; first < steps; first += kStretch) {
    const std::size_t count = std::min(kStretch, steps - first);
    if (findDepthSteps(count, &line.range[first], &line.squared_step[first], is_step.data()) == 0) {
      continue;
    }
    for (std::size_t n = first; n < first + count; ++n) {
      if (is_step[n - first] == 0) {
        continue;
      }
      const bool falls_back = line.range[n + 1] > line.range[n];
      const std::size_t begin = falls_back ? n + 1 : n + 1 - std::min(n + 1, half_window);
      const std::size_t end = falls_back ? std::min(unfit.size(), n + 1 + half_window) : n + 1;
      std::fill(unfit.begin() + static_cast<std::ptrdiff_t>(begin), unfit.begin() + static_cast<std::ptrdiff_t>(end),
                1);
    }
  }
}

}  // namespace

bool isBesideDepthStep(const LinePoints& line, int n)
{
  std::array<std::int32_t, 2> is_step{};
  const auto before = static_cast<std::size_t>(n - 1);
  return findDepthSteps(2, &line.range[before], &line.squared_step[before], is_step.data()) > 0;
}

void markUnfit(const LinePoints& line, const FeatureParameters& parameters, const LineNeighborhood& neighborhood,
               std::vector<std::int32_t>& unfit)
{
  unfit.resize(line.x.size());
  markOutOfRange(unfit.size(), line.range.data(), parameters.min_range, parameters.max_range, unfit.data());
  if (neighborhood.is_sparse) {
    markGrazingInDepth(line, unfit);
  } else {
    markGrazing(unfit.size(), line.range.data(), line.squared_step.data(), unfit.data());
  }
  markOccluded(line, static_cast<std::size_t>(neighborhood.each_side), unfit);
}

}  // namespace pcl_floam
