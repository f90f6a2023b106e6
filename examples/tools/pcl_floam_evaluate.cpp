// pcl_floam_evaluate: how accurate a trajectory is, with ground truth or without.

#include "accuracy.h"
#include "command_line.h"
#include "pose_pairs.h"
#include "result_writer.h"
#include "sharpness.h"
#include "trajectory_plot.h"

#include <pcl_floam/io/scan_source.h>

#include <filesystem>
#include <iostream>
#include <optional>

using namespace pcl_floam;
using namespace pcl_floam::tools;

namespace {

constexpr const char* kDescription =
    "Compares a trajectory with the true one: KITTI metric (t_rel, r_rel), ATE and RPE.\n"
    "TUM files are compared at the estimate's times; the truth is interpolated. KITTI files line by line.\n"
    "Without ground truth it tells how sharp a map the poses make of their scans, which compares trajectories over\n"
    "the same scans, or how far they wander where the sensor stood still.";

constexpr const char* kFooter =
    "\nExit status: 0 fine; 1 a result could not be written; 2 bad option, path or file.\n"
    "\nExamples:\n"
    "  pcl_floam_evaluate --estimate results/poses.kitti.txt --ground-truth poses.txt\n"
    "  pcl_floam_evaluate --estimate results/poses.tum.txt --ground-truth truth.tum.txt -o evaluation\n"
    "  pcl_floam_odometry SCANS --output results --save-scans undistorted\n"
    "  pcl_floam_evaluate --estimate results/poses.kitti.txt --scans undistorted\n"
    "  pcl_floam_evaluate --estimate results/poses.kitti.txt --at-rest --json\n";

struct EvaluationOptions {
  std::filesystem::path estimate;
  std::filesystem::path ground_truth;
  std::filesystem::path calibration;
  std::filesystem::path output;  ///< empty: text to the console only
  TrajectoryFormat format = TrajectoryFormat::automatic;
  AccuracyOptions accuracy;
  std::filesystem::path scans;
  MapSharpnessParameters sharpness;
  bool at_rest = false;
  bool json = false;
};

/// The results that were asked for.
struct Evaluation {
  std::vector<SE3> estimate;
  PosePairs pairs;
  std::optional<Accuracy> accuracy;
  std::optional<Sharpness> sharpness;
  std::optional<RestMetric> rest;
};

void addFileOptions(CLI::App& app, EvaluationOptions& o)
{
  app.option_defaults()->group("Files");
  app.add_option("--estimate", o.estimate, "the trajectory to judge")->required()->type_name("FILE");
  CLI::Option* truth = app.add_option("--ground-truth", o.ground_truth, "the true one")->type_name("FILE");
  addChoice(app, "--format", o.format,
            {{"auto", TrajectoryFormat::automatic}, {"kitti", TrajectoryFormat::kitti}, {"tum", TrajectoryFormat::tum}},
            "of both files; auto tells them by their columns");
  app.add_option("--calibration", o.calibration,
                 "KITTI's calib.txt, when the true poses are the camera's and the\n"
                 "estimated ones the lidar's")
      ->type_name("FILE")
      ->needs(truth);
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

void addOptionsWithoutTruth(CLI::App& app, EvaluationOptions& o)
{
  app.option_defaults()->group("Without ground truth");
  CLI::Option* scans = app.add_option("--scans", o.scans,
                                      "the scans of the estimate, undistorted, as --save-scans of\n"
                                      "pcl_floam_odometry writes them: as many as poses, or both with\n"
                                      "times; prints how sharp a map they make")
                           ->type_name("FOLDER");
  app.add_option("--radius", o.sharpness.radius, "of the neighbourhoods in that map whose spread is measured")
      ->type_name("M")
      ->check(positive())
      ->capture_default_str()
      ->needs(scans);
  app.add_flag("--at-rest", o.at_rest, "the sensor stood still: prints how far the estimate wanders");
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

PosePairs pairUp(const EvaluationOptions& o, const Trajectory& estimate)
{
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

Evaluation evaluate(const EvaluationOptions& o)
{
  if (o.ground_truth.empty() && o.scans.empty() && !o.at_rest) {
    throw std::invalid_argument("one of --ground-truth, --scans and --at-rest is required");
  }
  const Trajectory estimate = readTrajectory(o.estimate, o.format);
  Evaluation evaluation;
  for (const StampedPose& pose : estimate) {
    evaluation.estimate.push_back(pose.world_T_sensor);
  }
  if (!o.ground_truth.empty()) {
    evaluation.pairs = pairUp(o, estimate);
    evaluation.accuracy = measureAccuracy(evaluation.pairs, o.accuracy);
  }
  if (!o.scans.empty()) {
    evaluation.sharpness = measureSharpness(o.scans, {o.estimate, estimate, hasTimes(o.estimate)}, o.sharpness);
  }
  if (o.at_rest) {
    evaluation.rest = restMetric(evaluation.estimate);
  }
  return evaluation;
}

std::string textOf(const Evaluation& evaluation)
{
  std::string text;
  const auto add = [&text](const auto& part) { text += part ? (text.empty() ? "" : "\n") + describe(*part) : ""; };
  add(evaluation.accuracy);
  add(evaluation.sharpness);
  add(evaluation.rest);
  return text;
}

Json jsonOf(const Evaluation& evaluation)
{
  Json json = evaluation.accuracy ? toJson(*evaluation.accuracy) : Json{{"poses", evaluation.estimate.size()}};
  if (evaluation.sharpness) {
    json["sharpness"] = toJson(*evaluation.sharpness);
  }
  if (evaluation.rest) {
    json["rest"] = toJson(*evaluation.rest);
  }
  return json;
}

void writeResults(const EvaluationOptions& o, const Evaluation& evaluation)
{
  std::error_code error;
  std::filesystem::create_directories(o.output, error);
  writeTextFile(o.output / "evaluation.txt", textOf(evaluation) + "\n");
  writeTextFile(o.output / "evaluation.json", jsonOf(evaluation).dump(2) + "\n");
  const std::filesystem::path image = o.output / "evaluation.svg";
  const PosePairs& pairs = evaluation.pairs;
  const std::vector<SE3>& drawn = evaluation.accuracy ? pairs.estimate : evaluation.estimate;
  const std::string problem = drawTrajectory({o.estimate.string(), drawn, pairs, {}}, image);
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
  addOptionsWithoutTruth(app, options);
  addMetricOptions(app, options);
  app.footer(kFooter);
  if (const auto status = parseCommandLine(app, argc, argv)) {
    return *status;
  }
  try {
    const Evaluation evaluation = evaluate(options);
    std::cout << (options.json ? jsonOf(evaluation).dump(2) : textOf(evaluation)) << '\n';
    if (!options.output.empty()) {
      try {
        writeResults(options, evaluation);
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
