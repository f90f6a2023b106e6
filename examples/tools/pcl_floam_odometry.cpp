// pcl_floam_odometry: from a folder of scans or a recording to a trajectory and a map.

#include "accuracy.h"
#include "command_line.h"
#include "ground_truth.h"
#include "interruption.h"
#include "map_picture.h"
#include "occupancy_grid.h"
#include "odometry_options.h"
#include "odometry_run.h"
#include "run_summary.h"
#include "trajectory_plot.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_writer.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <system_error>

using namespace pcl_floam;
using namespace pcl_floam::tools;

namespace {

constexpr const char* kDescription =
    "Estimates the path of a lidar from its scans (F-LOAM), and builds a map on the way.\n"
    "Only SCANS and --output are needed; everything else has a sensible default.";

constexpr const char* kFooter =
    "\nResults: poses.kitti.txt, poses.tum.txt, timing.csv, scans.csv (each scan's state, share that the map\n"
    "explains, covariance and reason); all written scan by scan, the first poses again if later scans correct\n"
    "them; map_edges.pcd, map_planes.pcd, summary.json, trajectory.svg (drawn by gnuplot), map.png.\n"
    "\nExit status: 0 all scans tracked; 1 finished, but a scan could not be read or tracked or a result not\n"
    "written; 2 bad option or path; 130, 143 interrupted: the results so far are written.\n"
    "\nExamples:\n"
    "  pcl_floam_odometry scans/ -o results\n"
    "  pcl_floam_odometry drive.mcap --topic /lidar/points -o results\n"
    "  pcl_floam_odometry 2011_09_26_drive_0001_sync/velodyne_points/data -o results --vertical-correction 0.205\n"
    "  pcl_floam_odometry more_scans/ -o more_results --map results --localize --initial-pose 3,1.5,0,90\n"
    "  pcl_floam_odometry vlp16_scans/ -o results --sensor vlp16 --ground-truth truth.tum.txt\n";

/// \param values x, y, z in m and yaw in degrees, or nothing
SE3 initialPose(const std::vector<double>& values)
{
  SE3 pose;
  if (!values.empty()) {
    pose.translation = Eigen::Vector3d(values[0], values[1], values[2]);
    pose.rotation = expSO3(Eigen::Vector3d(0.0, 0.0, values[3] * M_PI / 180.0));
  }
  return pose;
}

/// \param values x, y, z in m and roll, pitch, yaw in degrees
SE3 sensorPose(const std::vector<double>& values)
{
  SE3 pose;
  pose.translation = Eigen::Vector3d(values[0], values[1], values[2]);
  for (int axis = 2; axis >= 0; --axis) {  // roll is applied first
    pose.rotation *= expSO3(values[static_cast<std::size_t>(3 + axis)] * M_PI / 180.0 * Eigen::Vector3d::Unit(axis));
  }
  return pose;
}

/// The map's files would be scans of the next run.
void refuseToWriteAmong(const ScanSource& scans, const std::filesystem::path& output)
{
  std::error_code error;
  const bool are_files = scans.format() == ScanFormat::pcd || scans.format() == ScanFormat::kitti_bin;
  if (are_files && std::filesystem::equivalent(scans.folder(), output, error)) {
    throw FileError(output, "is the folder of the scans: the results need another");
  }
}

/// `--calibration` is the lidar's, or that of the camera whose true poses are given: the file tells.
bool calibratesLidar(const OdometryOptions& options)
{
  return !options.calibration.empty() && isLaserCalibration(options.calibration);
}

ScanSourceOptions sourceOptions(const OdometryOptions& options)
{
  const bool of_lidar = calibratesLidar(options);
  if (!options.calibration.empty() && !of_lidar && options.ground_truth.empty()) {
    throw FileError(options.calibration,
                    "is no calibration of a Velodyne HDL-64 (XML or YAML), and KITTI's calib.txt needs --ground-truth");
  }
  return {options.topic, of_lidar ? options.calibration : std::filesystem::path()};
}

GridSettings gridSettings(const OdometryOptions& options)
{
  return {options.grid[0], options.grid[1], options.grid_cell};
}

/// All that a run needs, checked before it begins.
struct Preparation {
  Preparation(const OdometryOptions& options)
      : scans(options.scans, sourceOptions(options)),
        range(scanRange(options, scans.size())),
        odometry(parametersFor(options, scans.format()))
  {
    if (!options.ground_truth.empty()) {
      truth.emplace(options.ground_truth, calibratesLidar(options) ? "" : options.calibration, scans);
    }
    if (!options.sensor_pose.empty()) {
      odometry.setSensorPose(sensorPose(options.sensor_pose));
    }
    if (!options.map.empty()) {
      odometry.localizeIn(loadMap(options.map, odometry.getParameters().map), initialPose(options.initial_pose),
                          options.localize ? MapUse::frozen : MapUse::kept_current);
    }
    refuseToWriteAmong(scans, options.output);
    if (!options.grid.empty()) {
      check(gridSettings(options));
    }
    saver = ScanSaver(options.save_scans, odometry.getSensorPose());
    writer = std::make_unique<ResultWriter>(options.output);
  }

  ScanSource scans;
  ScanRange range;
  OdometryPipeline odometry;
  std::optional<GroundTruth> truth;
  std::unique_ptr<ResultWriter> writer;
  ScanSaver saver{""};
};

/// Runs one step that writes a result. \return whether it could
template <typename Step>
bool writeResult(const Step& step)
{
  try {
    step();
    return true;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return false;
  }
}

std::vector<Eigen::Vector3d> mapPoints(const KeyframeVoxelMap& map)
{
  std::vector<Eigen::Vector3d> points = map.points(FeatureKind::edge);
  const std::vector<Eigen::Vector3d> planes = map.points(FeatureKind::plane);
  points.insert(points.end(), planes.begin(), planes.end());
  return points;
}

std::vector<float> mapIntensities(const KeyframeVoxelMap& map)
{
  std::vector<float> intensities = map.intensities(FeatureKind::edge);
  const std::vector<float> planes = map.intensities(FeatureKind::plane);
  intensities.insert(intensities.end(), planes.begin(), planes.end());
  return intensities;
}

/// A missing gnuplot is told but no failure: the figures are all there.
void drawPlot(const OdometryOptions& options, const OdometryPipeline& odometry, const RunResult& result,
              const PosePairs& pairs)
{
  const std::filesystem::path image = options.output / ("trajectory" + options.plot);
  TrajectoryPlot plot;
  plot.title = options.scans.string();
  plot.estimate = result.poses;
  plot.pairs = pairs;
  plot.map_points = mapPoints(odometry.map());
  const std::string problem = drawTrajectory(plot, image);
  if (!problem.empty()) {
    std::cerr << image.string() << ": not drawn: " << problem << '\n';
  }
}

void drawMapPicture(const OdometryOptions& options, const OdometryPipeline& odometry, const RunResult& result)
{
  MapScene scene;
  scene.map = mapPoints(odometry.map());
  for (const SE3& pose : result.poses) {
    scene.path.push_back(pose.translation);
  }
  const std::filesystem::path image = options.output / "map.png";
  const std::string problem = drawMap(scene, image);
  if (!problem.empty()) {
    std::cerr << image.string() << ": not drawn: " << problem << '\n';
  }
}

/// What was asked for beside the usual results. \return whether all could be written
bool writeExtras(const OdometryOptions& options, const OdometryPipeline& odometry, const RunResult& result)
{
  std::vector<Eigen::Vector3d> path;
  for (const SE3& pose : result.poses) {
    path.push_back(pose.translation);
  }
  const std::vector<Eigen::Vector3d> map = mapPoints(odometry.map());
  bool written = true;
  if (options.ply) {
    written &= writeResult([&] { writePly(path, options.output / "path.ply"); });
    written &= writeResult([&] { writePly(map, options.output / "map.ply", mapIntensities(odometry.map())); });
  }
  if (!options.grid.empty()) {
    const OccupancyGrid grid = makeGrid(map, path, gridSettings(options));
    written &= writeResult([&] { writeGrid(grid, options.output / "grid"); });
  }
  return written;
}

int run(const OdometryOptions& options, Preparation& prepared)
{
  noteInterruptions();
  const RunResult result =
      runOdometry(prepared.odometry, prepared.scans, prepared.range, *prepared.writer, prepared.saver, options.quiet);
  const int signal = interruptedBy();
  const PosePairs pairs = prepared.truth ? pairWithTruth(result, *prepared.truth) : PosePairs();
  RunSummary summary{options, prepared.odometry, result, prepared.range.count, std::nullopt, signal};
  if (pairs.size() > 0) {
    summary.accuracy = measureAccuracy(pairs, {});
  }
  bool written = result.output_problem.empty();
  written &= writeResult([&] { saveMap(prepared.odometry.map(), options.output); });
  written &= writeExtras(options, prepared.odometry, result);
  written &= writeResult([&] { writeTextFile(options.output / "summary.json", toJson(summary).dump(2) + "\n"); });
  if (!options.plot.empty()) {
    drawPlot(options, prepared.odometry, result, pairs);
    drawMapPicture(options, prepared.odometry, result);
  }
  if (!options.quiet) {
    std::cout << describe(summary) << '\n';
  }
  if (signal != 0) {
    constexpr int kSignalBase = 128;  // as shells have it
    return kSignalBase + signal;
  }
  return written && result.isComplete() ? kExitFine : kExitIncomplete;
}

}  // namespace

int main(int argc, char** argv)
{
  OdometryOptions options;
  CLI::App app(kDescription, "pcl_floam_odometry");
  useReadableHelp(app);
  addOptions(app, options);
  app.footer(kFooter);
  if (const auto status = parseCommandLine(app, argc, argv)) {
    return *status;
  }
  std::unique_ptr<Preparation> prepared;
  try {
    prepared = std::make_unique<Preparation>(options);
  } catch (const std::exception& error) {
    return reportUsageError(app, error.what());
  }
  try {
    return run(options, *prepared);
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return kExitIncomplete;
  }
}
