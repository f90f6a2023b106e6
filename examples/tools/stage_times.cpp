#include "stage_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_floam::tools {

namespace {

/// Linear between the two samples around the rank.
double percentile(const std::vector<double>& sorted, double fraction)
{
  const double rank = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (rank - std::floor(rank)) * (sorted[above] - sorted[below]);
}

}  // namespace

TimeStatistics timeStatistics(const std::vector<StageTimes>& times, const Stage& stage)
{
  if (times.empty()) {
    return {};
  }
  std::vector<double> sorted(times.size());
  std::transform(times.begin(), times.end(), sorted.begin(),
                 [&stage](const StageTimes& scan) { return scan.*stage.time; });
  std::sort(sorted.begin(), sorted.end());
  TimeStatistics statistics;
  statistics.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
  statistics.median = percentile(sorted, 0.5);
  statistics.p95 = percentile(sorted, 0.95);
  statistics.max = sorted.back();
  return statistics;
}

}  // namespace pcl_floam::tools
