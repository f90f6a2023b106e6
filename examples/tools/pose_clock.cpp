#include "pose_clock.h"

namespace pcl_floam::tools {

std::vector<double> PoseClock::timesOf(const std::vector<std::optional<double>>& stamps)
{
  const auto n = static_cast<double>(stamps.size());
  const std::optional<double> end = stamps.back();
  const bool is_known = end && (!is_last_known_ || *end > last_);
  const double step = is_known && is_last_known_ ? (*end - last_) / n : period_;
  const double before = is_known ? *end - n * step : last_;
  std::vector<double> times;
  for (const std::optional<double>& stamp : stamps) {
    const double even = before + static_cast<double>(times.size() + 1) * step;
    times.push_back(stamp && *stamp > (times.empty() ? before : times.back()) ? *stamp : even);
  }
  last_ = times.back();
  is_last_known_ = is_last_known_ || is_known;
  return times;
}

}  // namespace pcl_floam::tools
