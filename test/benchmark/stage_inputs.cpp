#include "benchmark/stage_inputs.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <pcl/conversions.h>

#include <filesystem>

#ifdef PCL_FLOAM_WITH_SIMULATOR
#include "simulation.h"
#endif

namespace pcl_floam::benchmark {

ScanSequence realDrive(const std::string& data)
{
  ScanSequence sequence{"HDL-64, real drive", {}, {}};
  sequence.parameters.vertical_correction = 0.205;
  const std::filesystem::path folder = std::filesystem::path(data) / "kitti_raw_0001" / "velodyne";
  if (!std::filesystem::is_directory(folder)) {
    return sequence;
  }
  const ScanSource source(folder);
  sequence.scans.resize(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    source.read(i, sequence.scans[i]);
  }
  return sequence;
}

#ifdef PCL_FLOAM_WITH_SIMULATOR
ScanSequence simulatedSequence(const std::string& world, const std::string& sensor, std::size_t count)
{
  simulator::SimulationOptions options;
  options.world = world;
  options.sensor = sensor;
  simulator::Simulation simulation(options);
  ScanSequence sequence{sensor + ", " + world, {}, {}};
  sequence.scans.resize(std::min(count, simulation.size()));
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    pcl::toPCLPointCloud2(simulation.sweep(i).cloud, sequence.scans[i]);
  }
  return sequence;
}
#else
ScanSequence simulatedSequence(const std::string& world, const std::string& sensor, std::size_t /*count*/)
{
  return {sensor + ", " + world, {}, {}};
}
#endif

StageInput::StageInput(const ScanSequence& sequence)
    : parameters(sequence.parameters), scan(sequence.scans.back()), cloud(pcl::make_shared<CloudXYZI>())
{
  parameters.pose_instant = PoseInstant::middle;
  OdometryPipeline odometry(parameters);
  for (std::size_t i = 0; i + 1 < sequence.scans.size(); ++i) {
    odometry.track(viewOf(sequence.scans[i]));
  }
  map = odometry.map();
  const OdometryReport& report = odometry.track(viewOf(scan));
  world_T_scan = report.world_T_sensor;
  twist = report.registration.sweep_twist;
  pcl::fromPCLPointCloud2(scan, *cloud);
  findScanLines(viewOf(scan), parameters.sensor, ScanLineSource::automatic, lines);
  timing = findScanTiming(viewOf(scan), lines);
  extractFeatures(viewOf(scan), lines, timing, parameters.features, features);
}

}  // namespace pcl_floam::benchmark
