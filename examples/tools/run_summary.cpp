#include "run_summary.h"

#include "settings_json.h"
#include "stage_times.h"
#include "text_format.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <sys/resource.h>

#include <cmath>

namespace pcl_floam::tools {

namespace {

double peakMemoryMegabytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts it in KiB
}

Json scansJson(const RunSummary& summary)
{
  const RunResult& result = summary.result;
  Json unreadable = Json::array();
  for (const UnreadableScan& scan : result.unreadable) {
    unreadable.push_back({{"file", scan.file}, {"reason", scan.reason}});
  }
  return {{"planned", summary.planned_scans},
          {"processed", result.poses.size()},
          {"initialized", result.count(TrackingState::initialized)},
          {"tracked", result.count(TrackingState::tracked)},
          {"doubtful", result.count(TrackingState::doubtful)},
          {"predicted", result.count(TrackingState::predicted)},
          {"not_started", result.count(TrackingState::not_started)},
          {"provisional", result.provisional},
          {"with_weak_directions", result.with_weak_directions},
          {"unreadable", unreadable}};
}

Json timesJson(const std::vector<StageTimes>& times)
{
  Json json;
  for (const Stage& stage : kStages) {
    const TimeStatistics statistics = timeStatistics(times, stage);
    json[stage.name] = {
        {"median", statistics.median}, {"p95", statistics.p95}, {"mean", statistics.mean}, {"max", statistics.max}};
  }
  return json;
}

Json sigma(const Matrix6& covariance)
{
  return {std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)), std::sqrt(covariance(2, 2))};
}

/// Rows, as in a trajectory's file.
Json matrixOf(const SE3& pose)
{
  Json rows;
  for (Eigen::Index row = 0; row < 3; ++row) {
    const Eigen::RowVector4d values = pose.matrix().row(row);
    rows.push_back({values[0], values[1], values[2], values[3]});
  }
  return rows;
}

/// Why a scan was worked from scan lines, or from space.
std::string structureReason(const OdometryReport& scan)
{
  if (scan.scan_lines == 0) {
    return scan.scan_line_failure != ScanLineFailure::none ? toString(scan.scan_line_failure) : "no scan was read";
  }
  return formatted("%zu scan lines by %s, confidence %.2f", scan.scan_lines, toString(scan.scan_line_source),
                   static_cast<double>(scan.scan_line_confidence));
}

const char* structureOf(const OdometryReport& scan)
{
  return scan.scan_lines > 0 ? "scan lines" : "space";
}

Json structureJson(const OdometryReport& last)
{
  return {{"engine", toString(last.engine)},
          {"structure", structureOf(last)},
          {"structure_reason", structureReason(last)},
          {"scan_lines", last.scan_lines},
          {"scan_line_source", toString(last.scan_line_source)},
          {"scan_line_confidence", last.scan_line_confidence},
          {"timing_source", toString(last.timing_source)},
          {"points", last.points},
          {"edges", last.edges},
          {"planes", last.planes},
          {"position_sigma_m", sigma(last.covariance)}};
}

}  // namespace

Json toJson(const RunSummary& summary)
{
  const RunResult& result = summary.result;
  const KeyframeVoxelMap& map = summary.odometry.map();
  Json json;
  json["tool"] = std::string("pcl_floam_odometry ") + PCL_FLOAM_VERSION;
  json["input"] = summary.options.scans.string();
  json["interrupted_by_signal"] = summary.signal != 0 ? Json(summary.signal) : Json();
  json["scans"] = scansJson(summary);
  json["last_scan"] = structureJson(result.last_read);
  json["path_length_m"] = pathLength(result.poses);
  json["map_points"] = {{"edges", map.size(FeatureKind::edge)}, {"planes", map.size(FeatureKind::plane)}};
  json["milliseconds"] = timesJson(result.times);
  json["peak_memory_mb"] = peakMemoryMegabytes();
  if (summary.accuracy) {
    json["accuracy"] = toJson(*summary.accuracy);
    json["accuracy"]["ground_truth"] = summary.options.ground_truth.string();
    json["accuracy"]["vertical_correction_deg"] = summary.odometry.getParameters().vertical_correction;
  }
  json["settings"] = toJson(summary.odometry.getParameters());
  json["sensor_pose"] = matrixOf(summary.odometry.getSensorPose());
  return json;
}

std::string describe(const RunSummary& summary)
{
  const RunResult& result = summary.result;
  const OdometryReport& last = result.last_read;
  const TimeStatistics total = timeStatistics(result.times, kStages.back());
  std::string text =
      formatted("%-22s %zu of %zu, %zu tracked, %zu doubtful, %zu predicted, %zu unreadable, %zu provisional", "scans",
                result.poses.size(), summary.planned_scans,
                result.count(TrackingState::tracked) + result.count(TrackingState::initialized),
                result.count(TrackingState::doubtful), result.count(TrackingState::predicted), result.unreadable.size(),
                result.provisional);
  text += formatted("\n%-22s %s", "registered by", toString(last.engine));
  text += formatted("\n%-22s %s: %s; times by %s", "structure", structureOf(last), structureReason(last).c_str(),
                    toString(last.timing_source));
  if (result.with_weak_directions > 0) {
    text += formatted("\n%-22s in %zu scans: hardly constrained, there the prediction was kept", "weak directions",
                      result.with_weak_directions);
  }
  text += formatted("\n%-22s median %.1f ms, 95 %% below %.1f ms", "time per scan", total.median, total.p95);
  text += formatted("\n%-22s %.1f m", "path", pathLength(result.poses));
  if (summary.accuracy) {
    text += "\n" + describe(*summary.accuracy);
    text += formatted("\n%-22s %g deg", "vertical correction", summary.odometry.getParameters().vertical_correction);
  }
  text += formatted("\n%-22s %s", "results in", summary.options.output.c_str());
  return text;
}

}  // namespace pcl_floam::tools
