/// \file odometry_run.h
/// The run through a folder of scans.
#pragma once

#include "ground_truth.h"
#include "odometry_options.h"
#include "result_writer.h"
#include "scan_saver.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl_floam::tools {

/// A scan that could not be read.
struct UnreadableScan {
  std::string file;
  std::string reason;
};

/// What came of a run, finished or cut short.
struct RunResult {
  std::vector<std::size_t> scans;        ///< their numbers in the folder
  std::vector<SE3> poses;                ///< one each ...
  std::vector<double> stamps;            ///< ... and its time, s
  std::vector<StageTimes> times;         ///< of those that were read
  std::array<std::size_t, 5> states{};   ///< number of scans by TrackingState
  std::size_t provisional = 0;           ///< scans whose poses might still be corrected when they came
  std::size_t with_weak_directions = 0;  ///< scans that left a direction to the prediction
  std::vector<UnreadableScan> unreadable;
  OdometryReport last_read;    ///< of the last scan that was read
  std::string output_problem;  ///< why an output could not be written; the run ends with it

  [[nodiscard]] std::size_t count(TrackingState state) const { return states[static_cast<std::size_t>(state)]; }
  [[nodiscard]] std::size_t& count(TrackingState state) { return states[static_cast<std::size_t>(state)]; }
  /// Every scan was read and tracked.
  [[nodiscard]] bool isComplete() const;
};

/// The range of scans that the options ask for.
struct ScanRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// \throws std::invalid_argument if the folder has no scan of that number.
[[nodiscard]] ScanRange scanRange(const OdometryOptions& options, std::size_t scans_in_folder);

/// Where `times.txt` does not rise; empty if it does, or the scans are a recording's, whose times are told as they
/// come. The odometry takes such scans as if no time had passed, or one period where the clock was set by a hundred
/// periods or more.
[[nodiscard]] std::string timesProblem(const ScanSource& scans, ScanRange range);

/// Tracks scan after scan and writes what comes of each at once. Scans that cannot be read or tracked are told and
/// predicted over. Ends early on Ctrl-C, or if the results cannot be written.
[[nodiscard]] RunResult runOdometry(OdometryPipeline& odometry, const ScanSource& scans, ScanRange range,
                                    ResultWriter& writer, ScanSaver& saver, bool quiet);

/// The poses for which there is ground truth. The true ones are re-based: the first is the identity.
[[nodiscard]] PosePairs pairWithTruth(const RunResult& result, const GroundTruth& truth);

}  // namespace pcl_floam::tools
