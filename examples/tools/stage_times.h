/// \file stage_times.h
/// The stages of the data flow by name, and statistics of their times.
#pragma once

#include <pcl_floam/odometry/core/odometry_report.h>

#include <array>
#include <vector>

namespace pcl_floam::tools {

struct Stage {
  const char* name;
  double StageTimes::*time;
};

/// In the order of the data flow, the total last.
inline constexpr std::array<Stage, 5> kStages = {{{"scan_lines", &StageTimes::scan_lines},
                                                  {"features", &StageTimes::features},
                                                  {"registration", &StageTimes::registration},
                                                  {"map", &StageTimes::map},
                                                  {"total", &StageTimes::total}}};

/// Milliseconds per scan.
struct TimeStatistics {
  double mean = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

/// All zero without times.
[[nodiscard]] TimeStatistics timeStatistics(const std::vector<StageTimes>& times, const Stage& stage);

}  // namespace pcl_floam::tools
