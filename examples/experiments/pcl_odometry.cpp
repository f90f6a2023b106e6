// pcl_floam_pcl_odometry: scan-to-scan odometry with PCL's own registrations, for comparison.
//
// The scans are thinned by pcl::VoxelGrid and registered with a constant-velocity guess; nothing else is done. Poses
// and times are written as pcl_floam_odometry writes them, so that pcl_floam_evaluate judges both.

#include "pcl_registrations.h"

#include "command_line.h"
#include "result_writer.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/vertical_correction.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <pcl/common/point_tests.h>
#include <pcl/filters/voxel_grid.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>

using namespace pcl_floam;
using namespace pcl_floam::experiments;

namespace {

constexpr std::size_t kFewestPoints = 50;

struct Options {
  std::filesystem::path scans;
  std::filesystem::path output;
  std::string method = "gicp";
  RegistrationSettings registration;
  double leaf = 0.25;                // m
  double min_range = 0.5;            // m
  double vertical_correction = 0.0;  // degrees
  std::size_t max_scans = 0;
};

void addOptions(CLI::App& app, Options& o)
{
  app.add_option("SCANS", o.scans, "folder of .pcd scans, or of KITTI's .bin scans")->required();
  app.add_option("-o,--output", o.output, "folder for poses and times")->required();
  app.add_option("--method", o.method, "registration")->check(CLI::IsMember(scanMatcherNames()))->capture_default_str();
  app.add_option("--leaf", o.leaf, "m, VoxelGrid's leaf")->check(tools::positive())->capture_default_str();
  app.add_option("--max-distance", o.registration.max_distance, "m, between corresponding points")
      ->check(tools::positive())
      ->capture_default_str();
  app.add_option("--resolution", o.registration.resolution, "m, NDT's cells")
      ->check(tools::positive())
      ->capture_default_str();
  app.add_option("--iterations", o.registration.iterations, "most iterations")->capture_default_str();
  app.add_option("--min-range", o.min_range, "m, nearer points are left out")->capture_default_str();
  app.add_option("--vertical-correction", o.vertical_correction,
                 "degrees by which every point is turned up; KITTI's HDL-64 needs about 0.205")
      ->capture_default_str();
  app.add_option("--max-scans", o.max_scans, "use at most so many scans; 0 uses all")->capture_default_str();
}

/// What remains of a scan after removal of what is not finite or too near, thinned.
Cloud::Ptr thinned(const pcl::PCLPointCloud2& raw, const Options& o)
{
  const CloudView view = viewOf(raw);
  Cloud::Ptr good(new Cloud);
  for (std::size_t i = 0; i < view.size; ++i) {
    const pcl::PointXYZ point(view.x(i), view.y(i), view.z(i));
    if (pcl::isXYZFinite(point) && point.getVector3fMap().norm() >= static_cast<float>(o.min_range)) {
      good->push_back(point);
    }
  }
  VerticalCorrection<pcl::PointXYZ> correction;
  correction.setInputCloud(good);
  correction.setAngle(o.vertical_correction);
  Cloud::Ptr result(new Cloud);
  correction.filter(*result);
  good.swap(result);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  const auto leaf = static_cast<float>(o.leaf);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(good);
  grid.filter(*result);
  return result;
}

/// The track so far. A scan that cannot be registered is predicted over.
class Track {
public:
  explicit Track(const Options& o) : matcher_(makeScanMatcher(o.method, o.registration)) {}

  void add(const Cloud::Ptr& scan)
  {
    Eigen::Matrix4f motion = last_motion_;
    const bool usable = scan->size() >= kFewestPoints;
    if (usable && started_) {
      failures_ += matcher_->match(scan, last_motion_, motion) ? 0 : 1;
      motion = motion.allFinite() ? motion : last_motion_;
    } else if (usable) {
      matcher_->start(scan);
    }
    failures_ += usable ? 0 : 1;
    if (started_) {
      const Eigen::Matrix4d exact = motion.cast<double>();
      pose_ = pose_ * SE3(nearestRotation(exact.topLeftCorner<3, 3>()), exact.topRightCorner<3, 1>());
      last_motion_ = motion;
    }
    // Without its points the next scan has nothing to be registered to but the scan before the gap.
    started_ = started_ || usable;
  }

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] std::size_t failures() const { return failures_; }

private:
  std::unique_ptr<ScanMatcher> matcher_;
  Eigen::Matrix4f last_motion_ = Eigen::Matrix4f::Identity();
  SE3 pose_;
  std::size_t failures_ = 0;
  bool started_ = false;
};

double millisecondsToAdd(const Cloud::Ptr& scan, Track& track)
{
  const auto begin = std::chrono::steady_clock::now();
  track.add(scan);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

int run(const Options& o)
{
  const ScanSource scans(o.scans);
  std::filesystem::create_directories(o.output);
  TrajectoryWriter kitti(o.output / "poses.kitti.txt", TrajectoryFormat::kitti);
  TrajectoryWriter tum(o.output / "poses.tum.txt", TrajectoryFormat::tum);
  std::ofstream timing(o.output / "timing.csv");
  timing << "scan,total_ms\n";
  Track path(o);
  const std::size_t count = o.max_scans == 0 ? scans.size() : std::min(o.max_scans, scans.size());
  for (std::size_t i = 0; i < count; ++i) {
    pcl::PCLPointCloud2 raw;
    scans.read(i, raw);
    // Thinning belongs to the method's cost, reading does not.
    const auto begin = std::chrono::steady_clock::now();
    const Cloud::Ptr scan = thinned(raw, o);
    const double filtering =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const double registering = millisecondsToAdd(scan, path);
    const StampedPose pose{scans.stamp(i).value_or(0.1 * static_cast<double>(i)), path.pose()};
    kitti.write(pose);
    tum.write(pose);
    timing << i << ',' << filtering + registering << std::endl;
  }
  if (path.failures() > 0) {
    std::cerr << path.failures() << " of " << count << " scans did not converge\n";
  }
  return timing ? tools::kExitFine : tools::kExitIncomplete;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Scan-to-scan odometry with PCL's own registrations, for comparison.", "pcl_floam_pcl_odometry");
  addOptions(app, options);
  if (const auto status = tools::parseCommandLine(app, argc, argv)) {
    return *status;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    return tools::reportUsageError(app, error.what());
  }
}
