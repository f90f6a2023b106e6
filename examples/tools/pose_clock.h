/// \file pose_clock.h
/// When each pose was.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl_floam::tools {

/// The poses' times: the scans' stamps, as far as these are known and rise.
class PoseClock {
public:
  /// \param period s, between scans of which nothing tells; 0: that of most rotating lidars
  PoseClock(double period, std::size_t first_scan)
      : period_(period > 0.0 ? period : kUsualPeriod), last_((static_cast<double>(first_scan) - 1.0) * period_)
  {
  }

  /// \param stamps of scans that follow each other; only the last may be told
  std::vector<double> timesOf(const std::vector<std::optional<double>>& stamps);

private:
  static constexpr double kUsualPeriod = 0.1;  // s

  double period_;
  double last_;
  bool is_last_known_ = false;
};

}  // namespace pcl_floam::tools
