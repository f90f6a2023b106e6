#include "odometry/scan_preparation.h"

#include "common/point_moments.h"
#include "filters/scan_line_finders.h"

#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/filters/core/vertical_angle.h>

#include <algorithm>

namespace pcl_floam {

namespace {

/// Whether all points lie in one plane.
bool isSingleLayer(const CloudView& scan)
{
  constexpr double kThin = 1e-3;  // m: less than the noise of any wall
  constexpr int kFewest = 4;      // three always do
  PointMoments moments;
  for (std::size_t i = 0; i < scan.size; ++i) {
    if (isMeasurable(scan, i)) {
      moments.add({scan.x(i), scan.y(i), scan.z(i)});
    }
  }
  return moments.count() >= kFewest && moments.axes().variance[0] < kThin * kThin;
}

}  // namespace

void PreparedScan::findStructure(const CloudView& scan, const OdometryParameters& parameters, double period)
{
  findScanLines(scan, parameters.sensor, ScanLineSource::automatic, parameters.threads, grouping_, lines);
  const bool may_be_single = !lines.valid() || (parameters.engine == OdometryEngine::surfaces && lines.lines() == 1);
  if (may_be_single && isSingleLayer(scan)) {
    lines = ScanLines();
    lines.failure = ScanLineFailure::single_layer;
  }
  timing = findScanTiming(scan, lines, parameters.timing_source, parameters.threads);
  if (!timing.valid() && turns_ && parameters.timing_source == ScanTimingSource::automatic) {
    timing = findScanTiming(scan, lines, ScanTimingSource::azimuth, parameters.threads);
  }
  turns_ = turns_ || timing.source == ScanTimingSource::azimuth;
  sweep_fraction = timing.valid() && parameters.compensation != CompensationMode::none ? 1.0 : 0.0;
  if (timing.duration > 0.0 && period > 0.0) {
    sweep_fraction *= std::min(1.0, timing.duration / period);
  }
  isolated_returns_ = 0;
  if (lines.valid() && parameters.engine == OdometryEngine::surfaces) {
    isolated_returns_ = isolated_.leaveOut(scan, lines);
  }
}

bool PreparedScan::assumeTimes(const CloudView& scan, const OdometryParameters& parameters)
{
  const bool is_asked = parameters.timing_source == ScanTimingSource::azimuth;
  if ((!is_asked && parameters.timing_source != ScanTimingSource::automatic) ||
      parameters.compensation == CompensationMode::none) {
    return false;
  }
  if (timing.valid()) {
    return timing.source == ScanTimingSource::azimuth && !is_asked;
  }
  turns_ = turns_ || is_asked || (lines.valid() && goesRound(scan, lines));
  if (lines.sorted_by_azimuth && turns_) {
    timing = findScanTiming(scan, lines, ScanTimingSource::clockwise, parameters.threads);
    sweep_fraction = timing.valid() ? 1.0 : 0.0;
  }
  return timing.valid();
}

void PreparedScan::takeFeatures(const CloudView& scan, const OdometryParameters& parameters)
{
  extractFeatures(scan, lines, timing, parameters.features, {}, parameters.threads, selections_, features);
  correctVerticalAngle(parameters.vertical_correction, features);
}

ScanReturns PreparedScan::returnsOf(const CloudView& scan, const OdometryParameters& parameters) const
{
  return {scan,
          lines,
          timing,
          parameters.features.min_range,
          parameters.features.max_range,
          parameters.vertical_correction};
}

void PreparedScan::takeEdges(std::vector<ScanPoint>& edges) const
{
  edges.clear();
  for (const Feature& edge : features.edges) {
    const float time = timing.valid() ? edge.time : 0.5F;
    edges.push_back({edge.x, edge.y, edge.z, time, static_cast<std::uint32_t>(edge.line), edge.index, -1, {}});
  }
}

void PreparedScan::takeForMap(const CloudView& scan, const std::vector<ScanPoint>& by_space)
{
  features.clear();
  for (const ScanPoint& point : by_space) {
    features.planes.push_back({point.x, point.y, point.z, point.time, 0.0F, point.index,
                               scan.intensityOf(static_cast<std::size_t>(point.index))});
  }
}

void PreparedScan::describeIn(OdometryReport& report) const
{
  report.scan_line_failure = lines.failure;
  report.scan_line_source = lines.source;
  report.scan_line_confidence = lines.confidence;
  report.scan_lines = lines.lines();
  report.isolated_returns = isolated_returns_;
  report.timing_source = timing.source;
  if (timing.source == ScanTimingSource::azimuth) {
    report.timing_source = timing.clockwise ? ScanTimingSource::clockwise : ScanTimingSource::counterclockwise;
  }
  report.edges = features.edges.size();
  report.planes = features.planes.size();
}

}  // namespace pcl_floam
