// The command line of pcl_floam_odometry from any bytes.
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_targets.h"
#include "support/room_scans.h"

#include "command_line.h"
#include "odometry_options.h"

#include <pcl_floam/odometry/odometry.h>

#include <iostream>
#include <sstream>

namespace pcl_floam::test {

namespace {

/// What is printed while it lives goes here.
class Captured {
public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  [[nodiscard]] std::string text() const { return text_.str(); }

private:
  std::ostream& stream_;
  std::ostringstream text_;
  std::streambuf* before_;
};

/// Arguments, one a line, after the program's name; no more than a shell would pass on in one go.
std::vector<std::string> argumentsFrom(const std::uint8_t* bytes, std::size_t size)
{
  std::vector<std::string> arguments = {"pcl_floam_odometry"};
  std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes), size));
  for (std::string line; std::getline(lines, line);) {
    arguments.push_back(line.substr(0, line.find('\0')));
  }
  return arguments;
}

bool parse(CLI::App& app, std::vector<std::string> arguments)
{
  std::vector<char*> argv;
  for (std::string& argument : arguments) {
    argv.push_back(argument.data());
  }
  const Captured out(std::cout);
  const Captured err(std::cerr);
  const auto status = tools::parseCommandLine(app, static_cast<int>(argv.size()), argv.data());
  if (status) {
    const std::string message = err.text();
    mustHold(*status == 0 || *status == tools::kExitUsage, "another exit status than those documented");
    mustHold((*status == 0) == message.empty(), "a bad option without a message, or a message without one");
    mustHold(message.empty() || message.find('\n') == message.size() - 1, "a message of several lines");
  }
  return !status.has_value();
}

/// A scan that is quick to track.
const pcl::PointCloud<pcl::PointXYZ>& smallScan()
{
  static const pcl::PointCloud<pcl::PointXYZ> scan = [] {
    const std::string bytes = roomScan(0.0, 0.0);
    constexpr std::size_t kPointBytes = 4 * sizeof(float);
    constexpr std::size_t kColumns = 900;
    pcl::PointCloud<pcl::PointXYZ> cloud;
    for (std::size_t i = 0; i < bytes.size() / kPointBytes;
         i += (i / kColumns) % 4 == 0 ? 3 : kColumns - i % kColumns) {
      float point[3];
      std::memcpy(point, bytes.data() + i * kPointBytes, sizeof(point));
      cloud.push_back({point[0], point[1], point[2]});
    }
    return cloud;
  }();
  return scan;
}

}  // namespace

void fuzzOdometryOptions(const std::uint8_t* bytes, std::size_t size)
{
  tools::OdometryOptions options;
  CLI::App app("fuzzed", "pcl_floam_odometry");
  tools::useReadableHelp(app);
  tools::addOptions(app, options);
  if (!parse(app, argumentsFrom(bytes, size))) {
    return;
  }
  mustHold(options.initial_pose.empty() || options.initial_pose.size() == 4, "an initial pose of other than 4 numbers");
  constexpr int kMostThreads = 4;  // what a trial may take of the machine
  try {
    OdometryParameters parameters = tools::parametersFor(options, ScanFormat::pcd);
    parameters.threads = std::min(parameters.threads, kMostThreads);
    OdometryPipeline odometry(parameters);
    for (int scan = 0; scan < 2; ++scan) {
      mustHold(odometry.track(viewOf(smallScan())).world_T_sensor.isFinite(), "settings let a pose be not finite");
    }
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace pcl_floam::test
