// pcl_floam_simulate: writes the sweeps of a simulated lidar and its exact poses.

#include "dataset_writer.h"
#include "simulation.h"
#include "world.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

namespace {

namespace sim = pcl_floam::simulator;

struct Arguments {
  sim::SimulationOptions options;
  std::string output;
  std::size_t scans = 0;  // 0: the whole path
  sim::DatasetFormat format = sim::DatasetFormat::pcd;
};

void describe(CLI::App& app, Arguments& arguments)
{
  static const std::map<std::string, sim::DatasetFormat> formats{{"pcd", sim::DatasetFormat::pcd},
                                                                 {"kitti", sim::DatasetFormat::kitti}};
  static const std::map<std::string, sim::HeadRotation> rotations{{"cw", sim::HeadRotation::clockwise},
                                                                  {"ccw", sim::HeadRotation::counterclockwise}};
  sim::SimulationOptions& options = arguments.options;
  app.add_option("world", options.world, "Where the sensor moves")->required()->check(CLI::IsMember(sim::worldNames()));
  app.add_option("-o,--output", arguments.output, "Folder to write; its scan folder must be new or empty")->required();
  app.add_option("--sensor", options.sensor, "Sensor; default: vlp16, on roads hdl64")
      ->check(CLI::IsMember(sim::lidarNames()));
  app.add_option("--seed", options.seed, "Seed of world and noise")->capture_default_str();
  app.add_option("--scans", arguments.scans, "Number of sweeps; default: to the end of the path")
      ->check(CLI::PositiveNumber);
  app.add_option("--start", options.start, "Seconds into the path where the first sweep begins")->capture_default_str();
  app.add_option("--noise", options.range_noise, "Range noise, standard deviation in metres")->capture_default_str();
  app.add_option("--dropout", options.dropout, "Fraction of the returns lost at random")->capture_default_str();
  app.add_option("--rate", options.rate, "Sweeps per second")->capture_default_str();
  app.add_option("--format", arguments.format, "pcd, or kitti for .bin files ring by ring; default: pcd")
      ->transform(CLI::CheckedTransformer(formats))
      ->type_name("TEXT:{pcd,kitti}")
      ->option_text("TEXT:{pcd,kitti}");
  app.add_option("--rotation", options.rotation, "Head seen from above: cw or ccw; default: cw")
      ->transform(CLI::CheckedTransformer(rotations))
      ->type_name("TEXT:{cw,ccw}")
      ->option_text("TEXT:{cw,ccw}");
  app.add_flag("--smooth", options.smooth, "Corridor without doors");
  app.add_flag("--organized", options.organized, "PCD with one row per ring, NaN where there is no return");
}

void simulate(const Arguments& arguments)
{
  sim::Simulation simulation(arguments.options);
  const std::size_t count = arguments.scans == 0 ? simulation.size() : std::min(arguments.scans, simulation.size());
  if (count < arguments.scans) {
    std::cerr << "pcl_floam_simulate: the path ends after " << count << " sweeps\n";
  }
  sim::DatasetWriter writer(arguments.output, arguments.format);
  const bool show_progress = isatty(STDERR_FILENO) != 0;
  for (std::size_t k = 0; k < count; ++k) {
    writer.write(simulation.sweep(k));
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
