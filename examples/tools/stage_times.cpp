#include "stage_times.h"

#include "quantile.h"

#include <algorithm>
#include <numeric>

namespace pcl_floam::tools {

TimeStatistics timeStatistics(const std::vector<StageTimes>& times, const Stage& stage)
{
  if (times.empty()) {
    return {};
  }
  std::vector<double> taken(times.size());
  std::transform(times.begin(), times.end(), taken.begin(),
                 [&stage](const StageTimes& scan) { return scan.*stage.time; });
  TimeStatistics statistics;
  statistics.mean = std::accumulate(taken.begin(), taken.end(), 0.0) / static_cast<double>(taken.size());
  statistics.median = quantile(taken, 0.5);
  statistics.p95 = quantile(taken, 0.95);
  statistics.max = quantile(taken, 1.0);
  return statistics;
}

}  // namespace pcl_floam::tools
