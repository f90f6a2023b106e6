// pcl_floam_simulate: writes the sweeps of a simulated lidar and its exact poses.

#include "dataset_writer.h"
#include "kitti_sequence_writer.h"
#include "simulation.h"
#include "world.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace sim = pcl_floam::simulator;

enum class Format { pcd, kitti, kitti_odometry };

struct Arguments {
  sim::SimulationOptions options;
  std::string output;
  std::vector<double> gap;
  double beam_mrad = 0.0;
  std::size_t scans = 0;  // 0: the whole path
  Format format = Format::pcd;
  std::string sequence = "00";  // kitti-odometry
};

void describe(CLI::App& app, Arguments& arguments)
{
  static const std::map<std::string, Format> formats{
      {"pcd", Format::pcd}, {"kitti", Format::kitti}, {"kitti-odometry", Format::kitti_odometry}};
  static const std::map<std::string, sim::HeadRotation> rotations{{"cw", sim::HeadRotation::clockwise},
                                                                  {"ccw", sim::HeadRotation::counterclockwise}};
  static const std::map<std::string, sim::Family> families{
      {"tune", sim::Family::tune}, {"report", sim::Family::report}, {"test", sim::Family::test}};
  static const std::map<std::string, sim::Begin> begins{{"rest", sim::Begin::rest}, {"speed", sim::Begin::speed}};
  sim::SimulationOptions& options = arguments.options;
  app.add_option("world", options.world, "Where the sensor moves")->required()->check(CLI::IsMember(sim::worldNames()));
  app.add_option("-o,--output", arguments.output, "Folder to write; its scan folder must be new or empty")->required();
  app.add_option("--sensor", options.sensor, "Sensor; default: vlp16, in towns and on motorways hdl64")
      ->check(CLI::IsMember(sim::lidarNames()));
  app.add_option("--seed", options.seed, "Seed of world and noise")->capture_default_str();
  app.add_option("--family", options.family,
                 "tune, report or test: each draws its worlds from other ranges and other seeds; default: tune")
      ->transform(CLI::CheckedTransformer(families))
      ->type_name("TEXT:{tune,report,test}")
      ->option_text("TEXT:{tune,report,test}");
  app.add_option("--begin", options.begin, "open-road: from rest, or at speed from the first sweep; default: rest")
      ->transform(CLI::CheckedTransformer(begins))
      ->type_name("TEXT:{rest,speed}")
      ->option_text("TEXT:{rest,speed}");
  app.add_option("--speed", options.speed, "open-road: metres a second; default: drawn by the seed");
  app.add_option("--scans", arguments.scans, "Number of sweeps; default: to the end of the path")
      ->check(CLI::PositiveNumber);
  app.add_option("--start", options.start, "Seconds into the path where the first sweep begins")->capture_default_str();
  app.add_option("--standing", options.standing,
                 "The sensor stands, so many metres to the left of where the path is at --start");
  app.add_option("--range-noise,--noise", options.range_noise, "Range noise, standard deviation in metres")
      ->capture_default_str();
  app.add_option("--dropout", options.dropout, "Fraction of the returns lost at random")->capture_default_str();
  app.add_option("--field-of-view", options.field_of_view, "Degrees about the forward direction that are seen")
      ->capture_default_str();
  app.add_option("--gap", arguments.gap, "Seconds, FROM:TO, between which nothing returns")
      ->type_name("FROM:TO")
      ->delimiter(':')
      ->expected(2);
  app.add_option("--beam-divergence", arguments.beam_mrad,
                 "Width of the beam in mrad (VLP-16: 3): at depth edges returns lie between near and far")
      ->capture_default_str();
  app.add_option("--path", options.path, "Which way through the world; what stands is the same for the same seed")
      ->capture_default_str();
  app.add_flag("--truck", options.truck, "Roads: a lorry drives beside the sensor and fills a third of its view");
  app.add_option("--rate", options.rate, "Sweeps per second")->capture_default_str();
  app.add_option("--format", arguments.format,
                 "pcd; kitti for .bin files ring by ring; kitti-odometry for a sequence as KITTI's odometry benchmark "
                 "lays it out, compensated; default: pcd")
      ->transform(CLI::CheckedTransformer(formats))
      ->type_name("TEXT:{pcd,kitti,kitti-odometry}")
      ->option_text("TEXT:{pcd,kitti,kitti-odometry}");
  app.add_option("--sequence", arguments.sequence, "Number of the sequence, for kitti-odometry")->capture_default_str();
  app.add_option("--rotation", options.rotation, "Head seen from above: cw or ccw; default: cw")
      ->transform(CLI::CheckedTransformer(rotations))
      ->type_name("TEXT:{cw,ccw}")
      ->option_text("TEXT:{cw,ccw}");
  app.add_flag("--smooth", options.smooth, "Corridor without doors");
  app.add_flag("--organized", options.organized, "PCD with one row per ring, NaN where there is no return");
}

using SweepSink = std::function<void(const sim::Sweep&)>;

SweepSink sinkFor(const Arguments& arguments, const sim::Simulation& simulation)
{
  if (arguments.format == Format::kitti_odometry) {
    const auto writer = std::make_shared<sim::KittiSequenceWriter>(arguments.output, arguments.sequence);
    return [writer, &simulation](const sim::Sweep& sweep) { writer->write(simulation, sweep); };
  }
  const auto format = arguments.format == Format::pcd ? sim::DatasetFormat::pcd : sim::DatasetFormat::kitti;
  const auto writer = std::make_shared<sim::DatasetWriter>(arguments.output, format);
  return [writer](const sim::Sweep& sweep) { writer->write(sweep); };
}

void simulate(const Arguments& arguments)
{
  sim::Simulation simulation(arguments.options);
  const std::size_t count = arguments.scans == 0 ? simulation.size() : std::min(arguments.scans, simulation.size());
  if (count < arguments.scans) {
    std::cerr << "pcl_floam_simulate: the path ends after " << count << " sweeps\n";
  }
  const SweepSink write = sinkFor(arguments, simulation);
  const bool show_progress = isatty(STDERR_FILENO) != 0;
  for (std::size_t k = 0; k < count; ++k) {
    write(simulation.sweep(k));
    if (show_progress) {
      std::cerr << "\rsweep " << k + 1 << " of " << count << std::flush;
    }
  }
  if (show_progress) {
    std::cerr << '\n';
  }
}

}  // namespace

int main(int argc, char** argv)
{
  constexpr int kFailure = 1;
  constexpr int kBadUsage = 2;
  CLI::App app("Simulates a rotating lidar that moves through a world, and writes its sweeps and exact poses.",
               "pcl_floam_simulate");
  Arguments arguments;
  describe(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    std::cerr << "pcl_floam_simulate: " << error.what() << " (see --help)\n";
    return kBadUsage;
  }
  arguments.options.beam_divergence = 1e-3 * arguments.beam_mrad;
  if (arguments.gap.size() == 2) {
    arguments.options.gap_from = arguments.gap[0];
    arguments.options.gap_to = arguments.gap[1];
  }
  try {
    simulate(arguments);
  } catch (const std::invalid_argument& error) {
    std::cerr << "pcl_floam_simulate: " << error.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& error) {
    std::cerr << "pcl_floam_simulate: " << error.what() << '\n';
    return kFailure;
  }
  return 0;
}
