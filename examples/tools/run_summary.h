/// \file run_summary.h
/// A run in figures: summary.json and the few lines at its end.
#pragma once

#include "accuracy.h"
#include "odometry_run.h"

#include <optional>
#include <string>

namespace pcl_floam::tools {

/// Everything that the summary tells of.
struct RunSummary {
  const OdometryOptions& options;
  const OdometryPipeline& odometry;
  const RunResult& result;
  std::size_t planned_scans = 0;
  std::optional<Accuracy> accuracy;
  int signal = 0;  ///< that interrupted the run
};

/// The contents of summary.json.
[[nodiscard]] Json toJson(const RunSummary& summary);

/// Lines for a reader, without a final line end.
[[nodiscard]] std::string describe(const RunSummary& summary);

}  // namespace pcl_floam::tools
