// Scans from files of any bytes, followed as far as an odometry takes them.
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_targets.h"

#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <cmath>

namespace pcl_floam::test {

namespace {

void checkLines(const CloudView& scan, const ScanLines& lines)
{
  std::vector<std::uint8_t> seen(scan.size, 0);
  for (const std::int32_t index : lines.index) {
    const auto i = static_cast<std::size_t>(index);
    mustHold(i < scan.size && seen[i] == 0, "a scan line has a point twice, or one that does not exist");
    mustHold(std::isfinite(scan.x(i)) && std::isfinite(scan.y(i)) && std::isfinite(scan.z(i)),
             "a scan line has a point that is not finite");
    seen[i] = 1;
  }
}

void checkFeatures(const CloudView& scan, const ScanLines& lines, ScanTimingSource source)
{
  const ScanTiming timing = findScanTiming(scan, lines, source);
  FeatureSet features;
  extractFeatures(scan, lines, timing, FeatureParameters(), features);
  for (const auto* kind : {&features.edges, &features.planes}) {
    for (const Feature& feature : *kind) {
      mustHold(feature.time >= 0.0F && feature.time <= 1.0F, "a feature's time is outside the sweep");
      mustHold(std::isfinite(feature.x + feature.y + feature.z + feature.smoothness), "a feature is not finite");
    }
  }
}

void followScan(const CloudView& scan)
{
  ScanLines lines;
  for (int source = 0; source <= static_cast<int>(ScanLineSource::elevation_clusters); ++source) {
    findScanLines(scan, sensorModel("vlp16"), static_cast<ScanLineSource>(source), lines);
    checkLines(scan, lines);
    checkFeatures(scan, lines, ScanTimingSource::automatic);
  }
  findScanLines(scan, SensorModel(), ScanLineSource::automatic, lines);
  for (int source = 0; source <= static_cast<int>(ScanTimingSource::none); ++source) {
    checkFeatures(scan, lines, static_cast<ScanTimingSource>(source));
  }
  OdometryPipeline odometry;
  for (int again = 0; again < 3; ++again) {
    const OdometryReport& report = odometry.track(scan);
    mustHold(report.world_T_sensor.isFinite(), "a pose is not finite");
    const bool blind = report.state == TrackingState::predicted || report.state == TrackingState::not_started;
    mustHold(!blind || !report.reason.empty(), "a scan was not tracked, and no reason is given");
  }
}

template <typename Read>
void readAndFollow(const char* name, const std::uint8_t* bytes, std::size_t size, const Read& read)
{
  static const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
  try {
    read(writeInput(folder, name, bytes, size), cloud);
  } catch (const FileError&) {
    return;
  }
  const CloudView scan = viewOf(cloud);
  mustHold(scan.size == static_cast<std::size_t>(cloud.width) * cloud.height, "points are missing");
  followScan(scan);
}

}  // namespace

void fuzzPcd(const std::uint8_t* bytes, std::size_t size)
{
  readAndFollow("scan.pcd", bytes, size, readPcd);
}

void fuzzKittiBin(const std::uint8_t* bytes, std::size_t size)
{
  readAndFollow("scan.bin", bytes, size, readKittiBin);
}

}  // namespace pcl_floam::test
