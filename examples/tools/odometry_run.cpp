#include "odometry_run.h"

#include "interruption.h"
#include "pose_clock.h"
#include "progress_bar.h"

#include <algorithm>
#include <stdexcept>

namespace pcl_floam::tools {

namespace {

bool isRecording(const ScanSource& scans)
{
  return scans.format() != ScanFormat::pcd && scans.format() != ScanFormat::kitti_bin;
}

/// Reads and tracks scans.
class ScanTracker {
public:
  ScanTracker(OdometryPipeline& odometry, const ScanSource& scans, ProgressBar& progress, RunResult& result)
      : odometry_(odometry), scans_(scans), progress_(progress), result_(result)
  {
  }

  /// \return whether it can be read; else why not is told
  bool read(std::size_t scan)
  {
    try {
      scans_.read(scan, cloud_);
      (void)viewOf(cloud_);  // what contradicts itself cannot be tracked either
      return true;
    } catch (const std::exception& error) {
      result_.unreadable.push_back({scans_.name(scan), error.what()});
      progress_.message("cannot be read" + std::string(isRecording(scans_) ? "" : ", its pose is predicted") + ": " +
                        std::string(error.what()));
      return false;
    }
  }

  /// The scan that was read last.
  const OdometryReport& track(std::size_t scan)
  {
    takeStamp(scan);
    const OdometryReport& report = odometry_.track(viewOf(cloud_), stamp_);
    note(scan, report);
    result_.times.push_back(report.milliseconds);
    tell(scan, report);
    result_.last_read = report;
    return report;
  }

  /// One that could not be read. Of a recording its time is not known either.
  const OdometryReport& miss(std::size_t scan)
  {
    stamp_.reset();
    if (!isRecording(scans_)) {
      takeStamp(scan);
    }
    const OdometryReport& report = odometry_.trackMissing(stamp_);
    note(scan, report);
    return report;
  }

  /// After the last scan.
  void finish()
  {
    if (late_ > 1) {
      progress_.message("times: those of " + std::to_string(late_ - 1) +
                        " more scans are not after those of the scans before");
    }
  }

  /// Of a recording that of the last one alone, which has been read.
  [[nodiscard]] std::vector<std::optional<double>> stampsOf(const std::vector<std::size_t>& numbers) const
  {
    std::vector<std::optional<double>> stamps(numbers.size());
    for (std::size_t i = isRecording(scans_) ? numbers.size() - 1 : 0; i < numbers.size(); ++i) {
      stamps[i] = scans_.stamp(numbers[i]);
    }
    return stamps;
  }
  [[nodiscard]] const OdometryParameters& parameters() const { return odometry_.getParameters(); }
  [[nodiscard]] pcl::PCLPointCloud2& cloud() { return cloud_; }

private:
  void note(std::size_t scan, const OdometryReport& report)
  {
    result_.scans.push_back(scan);
    ++result_.count(report.state);
    if (isUndecided(report)) {
      ++undecided_;
    } else if (!report.provisional) {
      if (report.state == TrackingState::tracked) {  // it is plain now, and what was given out before is corrected
        result_.count(TrackingState::doubtful) -= undecided_;
        result_.count(TrackingState::tracked) += undecided_;
      }
      undecided_ = 0;
    }
    result_.provisional += report.provisional ? 1 : 0;
    result_.with_weak_directions += report.registration.weak_directions.empty() ? 0 : 1;
  }

  /// Doubtful as long as it is open how the sensor began to move.
  static bool isUndecided(const OdometryReport& report)
  {
    return report.provisional && report.state == TrackingState::doubtful;
  }

  void takeStamp(std::size_t scan)
  {
    stamp_ = scans_.stamp(scan);
    if (isRecording(scans_) && stamp_ && last_stamp_ && !(*stamp_ > *last_stamp_)) {
      tellTime(scan);
    }
    last_stamp_ = stamp_ ? stamp_ : last_stamp_;
  }

  /// Once: a clock that was set back may stay so.
  void tellTime(std::size_t scan)
  {
    if (late_++ == 0) {
      progress_.message(scans_.path(scan).string() + ": the time of " + scans_.name(scan) +
                        " is not after that of the scan before, and tells nothing. Is the driver's clock right, and "
                        "are the recordings in order?");
    }
  }

  void tell(std::size_t scan, const OdometryReport& report)
  {
    if (report.state == TrackingState::tracked) {
      doubt_.clear();
    }
    const std::string file = (scans_.path(scan).parent_path() / scans_.name(scan)).string();
    if (report.state == TrackingState::predicted || report.state == TrackingState::not_started) {
      progress_.message(file + ": not tracked: " + report.reason);
    } else if (report.state == TrackingState::doubtful) {
      if (!isUndecided(report) && report.reason != doubt_) {  // once for scans in a row
        progress_.message(file + ": doubtful: " + report.reason);
        doubt_ = report.reason;
      }
    } else if (!report.corrected_poses.empty() && !report.reason.empty()) {
      progress_.message(file + ": only now it is plain how the sensor moved: " +
                        std::to_string(report.corrected_poses.size()) + " poses before are corrected");
    } else if (!report.reason.empty()) {
      progress_.message(file + ": " + report.reason);
    }
    const ScanTimingSource asked = odometry_.getParameters().timing_source;
    if (result_.times.size() == 1 && report.timing_source == ScanTimingSource::none &&
        asked != ScanTimingSource::automatic && asked != ScanTimingSource::none) {
      progress_.message(file +
                        ": has no times of the kind that --timing asks for: its points are taken as of one instant");
    }
    if (report.provisional && !result_.last_read.provisional && !progress_.isQuiet()) {
      progress_.message(file +
                        ": the first scans do not tell yet how the sensor moves, or when each point was "
                        "measured: poses may be corrected");
    }
  }

  OdometryPipeline& odometry_;
  const ScanSource& scans_;
  ProgressBar& progress_;
  RunResult& result_;
  pcl::PCLPointCloud2 cloud_;
  std::size_t undecided_ = 0;
  std::string doubt_;     ///< that was told of
  std::size_t late_ = 0;  ///< scans whose time is not after the one before
  std::optional<double> stamp_;
  std::optional<double> last_stamp_;
};

/// Scans of which at most the last can be read.
void track(const std::vector<std::size_t>& scans, bool is_last_read, ScanTracker& tracker, PoseClock& clock,
           ResultWriter& writer, ScanSaver& saver)
{
  const std::vector<double> times = clock.timesOf(tracker.stampsOf(scans));
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const bool is_read = is_last_read && k + 1 == scans.size();
    const OdometryReport& report = is_read ? tracker.track(scans[k]) : tracker.miss(scans[k]);
    const double time = times[k] + report.since_stamp;
    writer.write(scans[k], time, report);
    if (is_read) {
      saver.save(scans[k], time, tracker.cloud(), report, tracker.parameters());
    }
  }
}

}  // namespace

bool RunResult::isComplete() const
{
  return unreadable.empty() && count(TrackingState::doubtful) == 0 && count(TrackingState::predicted) == 0 &&
         count(TrackingState::not_started) == 0;
}

ScanRange scanRange(const OdometryOptions& options, std::size_t scans_in_folder)
{
  if (options.from >= scans_in_folder) {
    throw std::invalid_argument("--from " + std::to_string(options.from) + ": there are only " +
                                std::to_string(scans_in_folder) + " scans, counted from 0");
  }
  const std::size_t rest = scans_in_folder - options.from;
  return {options.from, options.max_scans == 0 ? rest : std::min(rest, options.max_scans)};
}

std::string timesProblem(const ScanSource& scans, ScanRange range)
{
  std::size_t count = 0;
  std::string first;
  for (std::size_t i = range.first + 1; !isRecording(scans) && i < range.first + range.count && scans.stamp(i); ++i) {
    if (!(*scans.stamp(i) > *scans.stamp(i - 1))) {
      first = count++ == 0 ? scans.path(i).filename().string() : first;
    }
  }
  if (count == 0) {
    return {};
  }
  return "times.txt: the time of " + first + " is not after that of the scan before" +
         (count > 1 ? ", nor are " + std::to_string(count - 1) + " more" : "");
}

RunResult runOdometry(OdometryPipeline& odometry, const ScanSource& scans, ScanRange range, ResultWriter& writer,
                      ScanSaver& saver, bool quiet)
{
  RunResult result;
  ProgressBar progress(range.count, quiet);
  ScanTracker tracker(odometry, scans, progress, result);
  const std::string times_problem = timesProblem(scans, range);
  if (!times_problem.empty()) {
    progress.message(times_problem);
  }
  PoseClock clock(odometry.getParameters().scan_period, range.first);
  const auto unlessDiskIsFull = [&](const auto& step) {
    try {
      step();
    } catch (const FileError& error) {
      result.output_problem = error.what();
      progress.message(result.output_problem);
    }
  };
  unlessDiskIsFull([&] {
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < range.count && interruptedBy() == 0; ++i) {
      waiting.push_back(range.first + i);
      const bool is_read = tracker.read(waiting.back());
      // Where a recording is cut off, there need not have been another scan.
      if (is_read || !isRecording(scans)) {
        track(waiting, is_read, tracker, clock, writer, saver);
        waiting.clear();
      }
      progress.update(i + 1);
    }
  });
  unlessDiskIsFull([&] { saver.finish(); });
  tracker.finish();
  for (const StampedPose& pose : writer.written()) {
    result.poses.push_back(pose.world_T_sensor);
    result.stamps.push_back(pose.stamp);
  }
  return result;
}

PosePairs pairWithTruth(const RunResult& result, const GroundTruth& truth)
{
  PosePairs pairs;
  SE3 first_T_world;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    const std::optional<SE3> true_pose = truth.pose(result.scans[i], result.stamps[i]);
    if (true_pose) {
      first_T_world = pairs.size() == 0 ? true_pose->inverse() : first_T_world;
      pairs.add(result.poses[i], first_T_world * *true_pose);
    }
  }
  return pairs;
}

}  // namespace pcl_floam::tools
