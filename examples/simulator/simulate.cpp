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
  std::vector<double> gap, mount, turned_frame;
  double nod = 0.0;
  std::size_t scans = 0;  // 0: the whole path
  Format format = Format::pcd;
  std::string sequence = "00";  // kitti-odometry
};

/// An option that takes one of a few words.
template <typename Value>
void addChoice(CLI::App& app, const std::string& name, Value& value, const std::map<std::string, Value>& choices,
               const std::string& help)
{
  std::string words;
  for (const auto& [word, meaning] : choices) {
    words += (words.empty() ? "TEXT:{" : ",") + word;
  }
  app.add_option(name, value, help)
      ->transform(CLI::CheckedTransformer(choices))
      ->type_name(words + "}")
      ->option_text(words + "}");
}

void describeWorld(CLI::App& app, sim::SimulationOptions& options)
{
  static const std::map<std::string, sim::Family> families{
      {"tune", sim::Family::tune}, {"report", sim::Family::report}, {"test", sim::Family::test}};
  static const std::map<std::string, sim::Begin> begins{{"rest", sim::Begin::rest}, {"speed", sim::Begin::speed}};
  app.add_option("world", options.world, "Where the sensor moves")->required()->check(CLI::IsMember(sim::worldNames()));
  app.add_option("--seed", options.seed, "Seed of world and noise")->capture_default_str();
  addChoice(app, "--family", options.family, families,
            "Families draw their worlds from other ranges and other seeds; default: tune");
  app.add_option("--path", options.path, "Which way through the world; what stands is the same for the same seed")
      ->capture_default_str();
  addChoice(app, "--begin", options.begin, begins,
            "open-road: from rest, or at speed from the first sweep; default: rest");
  app.add_option("--speed", options.speed, "open-road: metres a second; default: drawn by the seed");
  app.add_option("--trajectory", options.trajectory.file,
                 "town, motorway: file of KITTI's odometry benchmark with the camera's poses to move along")
      ->check(CLI::ExistingFile);
  app.add_option("--from", options.trajectory.from, "Metres along the trajectory where the world begins")
      ->capture_default_str();
  app.add_option("--length", options.trajectory.length, "Metres of the trajectory")->capture_default_str();
  app.add_flag("--truck", options.truck, "Roads: a lorry drives beside the sensor and fills a third of its view");
  app.add_flag("--smooth", options.smooth, "Corridor without doors");
  app.add_option("--start", options.start, "Seconds into the path where the first sweep begins")->capture_default_str();
  app.add_option("--standing", options.standing,
                 "The sensor stands, so many metres to the left of where the path is at --start");
  app.add_option("--rain", options.weather.rain, "mm/h")->capture_default_str();
  app.add_option("--snow", options.weather.snow, "mm/h of water")->capture_default_str();
  app.add_option("--dust", options.weather.dust, "Dust or fog: extinction in 1/m, three over the visibility")
      ->capture_default_str();
  app.add_option("--stray", options.weather.stray,
                 "Part of the beams that return any range, by sunlight or another lidar")
      ->capture_default_str();
}

void describeSensor(CLI::App& app, Arguments& arguments)
{
  static const std::map<std::string, sim::HeadRotation> rotations{{"cw", sim::HeadRotation::clockwise},
                                                                  {"ccw", sim::HeadRotation::counterclockwise}};
  sim::SimulationOptions& options = arguments.options;
  app.add_option("--sensor", options.sensor, "Sensor; default: vlp16, in towns and on motorways hdl64")
      ->check(CLI::IsMember(sim::lidarNames()));
  app.add_option("--rate", options.rate, "Sweeps per second")->capture_default_str();
  addChoice(app, "--rotation", options.rotation, rotations, "Head seen from above: cw or ccw; default: cw");
  app.add_option("--reach", options.reach, "Metres, nothing farther away is told of (KITTI's scans: 80); 0: all")
      ->capture_default_str();
  app.add_option("--carrier", options.carrier,
                 "Metres behind the sensor to the front of what carries it, 2.5 m wide, which is seen as well; 0: none")
      ->capture_default_str();
  app.add_option("--field-of-view", options.field_of_view, "Degrees about the forward direction that are seen")
      ->capture_default_str();
  app.add_option("--mount", arguments.mount,
                 "Degrees ROLL,PITCH,YAW of the sensor on what carries it; 180,0,0: upside down")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--nod", arguments.nod, "Degrees that what carries the sensor nods up and down, as what walks does")
      ->capture_default_str();
  app.add_option("--nod-rate", options.nod_rate, "Nods a second")->capture_default_str();
  app.add_option("--turned-frame", arguments.turned_frame,
                 "Degrees ROLL,PITCH,YAW of the frame that points and poses are given in, against the sensor's own")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--gap", arguments.gap, "Seconds, FROM:TO, between which nothing returns")
      ->type_name("FROM:TO")
      ->delimiter(':')
      ->expected(2);
}

void describeErrors(CLI::App& app, Arguments& arguments)
{
  static const std::map<std::string, sim::Realism> realisms{{"ideal", sim::Realism::ideal},
                                                            {"real", sim::Realism::real}};
  sim::SimulationOptions& options = arguments.options;
  app.add_option("--range-noise,--noise", options.range_noise, "Range noise, standard deviation in metres")
      ->capture_default_str();
  app.add_option("--dropout", options.dropout, "Fraction of the returns lost at random")->capture_default_str();
  addChoice(app, "--realism", options.realism, realisms,
            "The errors below: none, or those of the sensor's kind; each can be given as well; default: ideal");
  for (const sim::SensorErrorOption& option : sim::sensorErrorOptions()) {
    app.add_option_function<double>(
        "--" + option.name, [&options, name = option.name](double value) { options.errors[name] = value; },
        option.help);
  }
}

void describeOutput(CLI::App& app, Arguments& arguments)
{
  static const std::map<std::string, Format> formats{
      {"pcd", Format::pcd}, {"kitti", Format::kitti}, {"kitti-odometry", Format::kitti_odometry}};
  app.add_option("-o,--output", arguments.output, "Folder to write; its scan folder must be new or empty")->required();
  app.add_option("--scans", arguments.scans, "Number of sweeps; default: to the end of the path")
      ->check(CLI::PositiveNumber);
  addChoice(
      app, "--format", arguments.format, formats,
      "pcd; kitti for .bin files ring by ring; kitti-odometry for a sequence as KITTI's odometry benchmark lays it "
      "out, compensated; default: pcd");
  app.add_option("--sequence", arguments.sequence, "Number of the sequence, for kitti-odometry")->capture_default_str();
  app.add_flag("--organized", arguments.options.organized, "PCD with one row per ring, NaN where there is no return");
}

sim::RollPitchYaw inRadians(const std::vector<double>& degrees)
{
  constexpr double kDegree = 0.017453292519943295;  // rad
  return degrees.empty() ? sim::RollPitchYaw()
                         : sim::RollPitchYaw{kDegree * degrees[0], kDegree * degrees[1], kDegree * degrees[2]};
}

/// What is not in the simulation's own units on the command line.
void convert(Arguments& arguments)
{
  sim::SimulationOptions& options = arguments.options;
  options.mount = inRadians(arguments.mount);
  options.nod = inRadians({0.0, arguments.nod, 0.0}).pitch;
  options.turned_frame = inRadians(arguments.turned_frame);
  if (arguments.gap.size() == 2) {
    options.gap_from = arguments.gap[0];
    options.gap_to = arguments.gap[1];
  }
}

using SweepSink = std::function<void(const sim::Sweep&)>;

SweepSink sinkFor(const Arguments& arguments, const sim::Simulation& simulation)
{
  if (arguments.format == Format::kitti_odometry) {
    const auto writer = std::make_shared<sim::KittiSequenceWriter>(arguments.output, arguments.sequence);
    return [writer, &simulation](const sim::Sweep& sweep) { writer->write(simulation, sweep); };
  }
  const auto pcd = simulation.sensor().isLivox() ? sim::DatasetFormat::livox : sim::DatasetFormat::pcd;
  const auto format = arguments.format == Format::pcd ? pcd : sim::DatasetFormat::kitti;
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
  CLI::App app("Simulates a lidar that moves through a world, and writes its sweeps and exact poses.",
               "pcl_floam_simulate");
  Arguments arguments;
  describeWorld(app, arguments.options);
  describeSensor(app, arguments);
  describeErrors(app, arguments);
  describeOutput(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    std::cerr << "pcl_floam_simulate: " << error.what() << " (see --help)\n";
    return kBadUsage;
  }
  convert(arguments);
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
