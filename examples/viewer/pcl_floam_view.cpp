// pcl_floam_view: replays what an odometry run has left in its folder, or a run that is still at work.

#include "command_line.h"
#include "odometry_result.h"
#include "replay.h"
#include "scene.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/registration/core/cloud_features.h>

#include <pcl/conversions.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>

using namespace pcl_floam;
using namespace pcl_floam::viewer;

namespace {

constexpr const char* kDescription =
    "Shows the output folder of pcl_floam_odometry: the map (planes grey, edges orange), the path (green),\n"
    "and with --scans every scan at its pose (planes blue, edges red). The run may still be at work.";

constexpr const char* kFooter =
    "\nKeys: space pauses; right and left go one pose on and back, Home and End to the first and last;\n"
    "t follows the sensor or lets the view free; q quits. The mouse turns, shifts and zooms.\n"
    "\nExit status: 0 fine; 1 the picture could not be written; 2 bad option or path, or no display.\n"
    "\nExamples:\n"
    "  pcl_floam_view results --scans scans/\n"
    "  xvfb-run -a pcl_floam_view results --screenshot map.png\n";

struct ViewOptions {
  std::filesystem::path folder;
  std::filesystem::path scans;
  std::filesystem::path screenshot;
  std::optional<std::size_t> pose;
  std::size_t from = 0;
  double rate = 10.0;
};

void addOptions(CLI::App& app, ViewOptions& o)
{
  app.add_option("DIR", o.folder, "output folder of pcl_floam_odometry")->required()->type_name("");
  app.add_option("--scans", o.scans, "the folder of scans that the odometry was given")->type_name("FOLDER");
  app.add_option("--from", o.from, "the scan of the first pose, as given to the odometry")
      ->type_name("N")
      ->check(tools::notNegative())
      ->capture_default_str();
  app.add_option("--rate", o.rate, "poses per second")
      ->type_name("HZ")
      ->check(tools::positive())
      ->capture_default_str();
  app.add_option("--pose", o.pose, "begin here; for a picture, show this one instead of the whole path")
      ->type_name("N")
      ->check(tools::notNegative());
  app.add_option("--screenshot", o.screenshot, "write a picture (PNG) without opening a window")->type_name("FILE");
  app.set_help_flag("-h,--help", "this help");
  app.set_version_flag("--version", PCL_FLOAM_VERSION);
}

Cloud::Ptr cloudOf(const std::vector<Feature>& features)
{
  auto cloud = pcl::make_shared<Cloud>();
  for (const Feature& feature : features) {
    cloud->push_back({feature.x, feature.y, feature.z});
  }
  return cloud;
}

SeenScan readScan(const ScanSource& scans, std::size_t number)
{
  pcl::PCLPointCloud2 blob;
  scans.read(number, blob);
  SeenScan scan;
  pcl::fromPCLPointCloud2(blob, *scan.points);
  const FeatureSet features = scanLineFeatures(viewOf(blob), SensorModel(), FeatureParameters());
  scan.edges = cloudOf(features.edges);
  scan.planes = cloudOf(features.planes);
  return scan;
}

/// The view of one run, from the files to the picture.
class View {
public:
  View(const ViewOptions& options, OdometryResult result, std::optional<ScanSource> scans)
      : options_(options),
        result_(std::move(result)),
        scans_(std::move(scans)),
        replay_(options.rate, options.pose.value_or(options.screenshot.empty() ? 0 : result_.poses().size() - 1)),
        scene_(!options.screenshot.empty(), [this](const std::string& key) { press(key); })
  {
    replay_.setSize(result_.poses().size());
    scene_.showMap(result_);
  }

  void replay()
  {
    using Clock = std::chrono::steady_clock;
    auto last = Clock::now();
    auto last_refresh = last;
    constexpr std::chrono::milliseconds kRefresh(500);
    do {
      const auto now = Clock::now();
      replay_.advance(std::chrono::duration<double>(now - last).count());
      last = now;
      if (now - last_refresh > kRefresh) {
        refresh();
        last_refresh = now;
      }
      showCurrent();
    } while (scene_.draw());
  }

  void takePicture()
  {
    showCurrent();
    if (!options_.pose) {
      scene_.overlook(result_.poses());
    }
    scene_.draw();
    scene_.save(options_.screenshot.string());
  }

private:
  void press(const std::string& key)
  {
    following_ = key == "t" ? !following_ : following_;
    replay_.press(key);
  }

  void refresh()
  {
    if (result_.refresh()) {
      replay_.setSize(result_.poses().size());
      scene_.showMap(result_);
      if (shown_ && *shown_ < result_.poses().size()) {  // the scan and the camera stay as they are
        scene_.showPath(result_.poses(), *shown_);
      }
    }
  }

  /// Shows the present pose, unless it is shown already.
  void showCurrent()
  {
    const std::size_t current = replay_.current();
    const SE3& world_T_sensor = result_.poses()[current].world_T_sensor;
    if (shown_ != current) {
      scene_.showPath(result_.poses(), current);
      showScan(current, world_T_sensor);
      if (following_) {
        scene_.follow(world_T_sensor);
      }
    }
    shown_ = current;
    scene_.showText("pose " + std::to_string(current) + " of 0 to " + std::to_string(result_.poses().size() - 1) +
                    (replay_.isPaused() ? ", paused" : "") + problem_);
  }

  void showScan(std::size_t pose, const SE3& world_T_sensor)
  {
    const std::size_t number = options_.from + pose;
    if (!scans_) {
      return;
    }
    problem_.clear();
    SeenScan scan;
    try {
      if (number < scans_->size()) {
        scan = readScan(*scans_, number);
      }
    } catch (const FileError& error) {
      problem_ = ", scan not shown: " + std::string(error.what());
    }
    scene_.showScan(scan, world_T_sensor);
  }

  const ViewOptions& options_;
  OdometryResult result_;
  std::optional<ScanSource> scans_;
  Replay replay_;
  Scene scene_;
  std::optional<std::size_t> shown_;
  std::string problem_;
  bool following_ = true;
};

}  // namespace

int main(int argc, char** argv)
{
  ViewOptions options;
  CLI::App app(kDescription, "pcl_floam_view");
  tools::useReadableHelp(app);
  addOptions(app, options);
  app.footer(kFooter);
  if (const auto status = tools::parseCommandLine(app, argc, argv)) {
    return *status;
  }
  try {
    OdometryResult result(options.folder);
    if (options.pose.value_or(0) >= result.poses().size()) {
      throw FileError(options.folder, "has " + std::to_string(result.poses().size()) + " poses, none of that number");
    }
    std::optional<ScanSource> scans;
    if (!options.scans.empty()) {
      scans.emplace(options.scans);
    }
    const char* display = std::getenv("DISPLAY");
    if (display == nullptr || *display == '\0') {  // VTK would end the program
      return tools::reportUsageError(app, "no display: set DISPLAY, or run it by xvfb-run -a");
    }
    View view(options, std::move(result), std::move(scans));
    options.screenshot.empty() ? view.replay() : view.takePicture();
  } catch (const std::exception& error) {
    return tools::reportUsageError(app, error.what());
  }
  if (!options.screenshot.empty() && !std::filesystem::exists(options.screenshot)) {
    std::cerr << options.screenshot.string() << ": cannot be written\n";
    return tools::kExitIncomplete;
  }
  return tools::kExitFine;
}
