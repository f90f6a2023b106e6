// pcl_floam_evaluate: how accurate a trajectory is.

#include "accuracy.h"
#include "command_line.h"
#include "pose_pairs.h"
#include "result_writer.h"
#include "trajectory_plot.h"

#include <pcl_floam/io/scan_source.h>

#include <filesystem>
#include <iostream>

using namespace pcl_floam;
using namespace pcl_floam::tools;

namespace {

constexpr const char* kDescription =
    "Compares a trajectory with the true one: KITTI metric (t_rel, r_rel), ATE and RPE.\n"
    "TUM files are compared at the estimate's times; the truth is interpolated. KITTI files line by line.";

constexpr const char* kFooter =
    "\nExit status: 0 fine; 1 a result could not be written; 2 bad option, path or file.\n"
    "\nExamples:\n"
    "  pcl_floam_evaluate --estimate results/poses.kitti.txt --ground-truth poses.txt\n"
    "  pcl_floam_evaluate --estimate results/poses.tum.txt --ground-truth truth.tum.txt -o evaluation\n";

struct EvaluationOptions {
  std::filesystem::path estimate;
  std::filesystem::path ground_truth;
  std::filesystem::path calibration;
  std::filesystem::path output;  ///< empty: text to the console only
  TrajectoryFormat format = TrajectoryFormat::automatic;
  AccuracyOptions accuracy;
  bool json = false;
};

void addFileOptions(CLI::App& app, EvaluationOptions& o)
{
  app.option_defaults()->group("Files");
  app.add_option("--estimate", o.estimate, "the trajectory to judge")->required()->type_name("FILE");
  app.add_option("--ground-truth", o.ground_truth, "the true one")->required()->type_name("FILE");
  addChoice(app, "--format", o.format,
            {{"auto", TrajectoryFormat::automatic}, {"kitti", TrajectoryFormat::kitti}, {"tum", TrajectoryFormat::tum}},
            "of both files; auto tells them by their columns");
  app.add_option("--calibration", o.calibration,
                 "KITTI's calib.txt, when the true poses are the camera's and the\n"
                 "estimated ones the lidar's")
      ->type_name("FILE");
  app.add_option("-o,--output", o.output, "folder for evaluation.txt, evaluation.json and evaluation.svg")
      ->type_name("FOLDER");
  app.add_flag("--json", o.json, "print JSON instead of text");
}

void addMetricOptions(CLI::App& app, EvaluationOptions& o)
{
  app.option_defaults()->group("Metrics");
  app.add_option("--lengths", o.accuracy.lengths,
                 "of the sub-sequences in the KITTI metric; by default 100 to 800,\n"
                 "and tenths of a path that is shorter than 200 m")
      ->type_name("M,M,...")
      ->delimiter(',')
      ->check(positive());
  app.add_option(
         "--step", o.accuracy.step,
         "poses from one sub-sequence's start to the next one's; by\ndefault 10 as KITTI's, and 1 for short paths")
      ->type_name("N")
      ->check(positive());
  addChoice(app, "--align", o.accuracy.align, {{"se3", true}, {"first", false}},
            "before ATE: best rigid motion, or first pose onto first pose");
  app.add_option("--rpe-step", o.accuracy.rpe_step, "RPE: poses from the first to the second of a pair")
      ->type_name("N")
      ->check(positive())
      ->capture_default_str();
  app.set_help_flag("-h,--help", "this help");
  app.set_version_flag("--version", PCL_FLOAM_VERSION);
}

bool hasTimes(const std::filesystem::path& file)
{
  return trajectoryFormat(file) == TrajectoryFormat::tum;
}

PosePairs pairByTime(const Trajectory& estimate, const Trajectory& truth)
{
  PosePairs pairs;
  for (const StampedPose& pose : estimate) {
    if (const auto true_pose = poseAt(truth, pose.stamp)) {
      pairs.add(pose.world_T_sensor, *true_pose);
    }
  }
  return pairs;
}

PosePairs pairByLine(const Trajectory& estimate, const Trajectory& truth)
{
  PosePairs pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    pairs.add(estimate[i].world_T_sensor, truth[i].world_T_sensor);
  }
  return pairs;
}

PosePairs pairUp(const EvaluationOptions& o)
{
  const Trajectory estimate = readTrajectory(o.estimate, o.format);
  Trajectory truth = readTrajectory(o.ground_truth, o.format);
  if (!o.calibration.empty()) {
    cameraToLidar(o.calibration, truth);
  }
  PosePairs pairs;
  if (hasTimes(o.estimate) && hasTimes(o.ground_truth)) {
    requireRisingStamps(truth, o.ground_truth);
    pairs = pairByTime(estimate, truth);
  } else if (estimate.size() == truth.size()) {
    pairs = pairByLine(estimate, truth);
  } else {
    throw FileError(o.estimate, "has " + std::to_string(estimate.size()) + " poses, the ground truth " +
                                    std::to_string(truth.size()) + ", and not both have times");
  }
  if (pairs.size() < 2) {
    throw FileError(o.estimate, "fewer than two poses are within the time of the ground truth");
  }
  return pairs;
}

void writeResults(const EvaluationOptions& o, const PosePairs& pairs, const Accuracy& accuracy)
{
  std::error_code error;
  std::filesystem::create_directories(o.output, error);
  writeTextFile(o.output / "evaluation.txt", describe(accuracy) + "\n");
  writeTextFile(o.output / "evaluation.json", toJson(accuracy).dump(2) + "\n");
  const std::filesystem::path image = o.output / "evaluation.svg";
  const std::string problem = drawTrajectory({o.estimate.string(), pairs.estimate, pairs, {}}, image);
  if (!problem.empty()) {
    std::cerr << image.string() << ": not drawn: " << problem << '\n';
  }
}

}  // namespace

int main(int argc, char** argv)
{
  EvaluationOptions options;
  CLI::App app(kDescription, "pcl_floam_evaluate");
  useReadableHelp(app);
  addFileOptions(app, options);
  addMetricOptions(app, options);
  app.footer(kFooter);
  if (const auto status = parseCommandLine(app, argc, argv)) {
    return *status;
  }
  try {
    const PosePairs pairs = pairUp(options);
    const Accuracy accuracy = measureAccuracy(pairs, options.accuracy);
    std::cout << (options.json ? toJson(accuracy).dump(2) : describe(accuracy)) << '\n';
    if (!options.output.empty()) {
      try {
        writeResults(options, pairs, accuracy);
      } catch (const FileError& error) {
        std::cerr << error.what() << '\n';
        return kExitIncomplete;
      }
    }
  } catch (const std::exception& error) {
    return reportUsageError(app, error.what());
  }
  return kExitFine;
}
