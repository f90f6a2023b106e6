#include "sharpness.h"

#include "pose_pairs.h"
#include "text_format.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <stdexcept>
#include <vector>

namespace pcl_floam::tools {

namespace {

/// The pose of each scan, by number or else by time.
std::vector<std::optional<SE3>> posesOf(const ScanSource& scans, const TrajectoryFile& trajectory)
{
  std::vector<std::optional<SE3>> poses(scans.size());
  const bool by_number = scans.size() == trajectory.poses.size();
  if (!by_number && !(trajectory.has_times && scans.stamp(0))) {
    throw FileError(scans.folder(), "has " + std::to_string(scans.size()) + " scans for " +
                                        std::to_string(trajectory.poses.size()) + " poses, and not both have times");
  }
  if (!by_number) {
    requireRisingStamps(trajectory.poses, trajectory.path);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (by_number) {
      poses[i] = trajectory.poses[i].world_T_sensor;
    } else if (const std::optional<double> stamp = scans.stamp(i)) {
      poses[i] = poseAt(trajectory.poses, *stamp);
    }
  }
  return poses;
}

void readPoints(const ScanSource& scans, std::size_t scan, std::vector<Eigen::Vector3f>& points)
{
  pcl::PCLPointCloud2 cloud;
  scans.read(scan, cloud);
  try {
    const CloudView view = viewOf(cloud);
    points.clear();
    for (std::size_t i = 0; i < view.size; ++i) {
      points.emplace_back(view.x(i), view.y(i), view.z(i));
    }
  } catch (const std::invalid_argument& error) {
    throw FileError(scans.path(scan), error.what());
  }
}

}  // namespace

Sharpness measureSharpness(const std::filesystem::path& scans, const TrajectoryFile& trajectory,
                           const MapSharpnessParameters& parameters)
{
  const ScanSource source(scans);
  const std::vector<std::optional<SE3>> poses = posesOf(source, trajectory);
  MapSharpnessEstimation estimation(parameters);
  Sharpness sharpness;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i]) {
      readPoints(source, i, points);
      estimation.addScan(points, *poses[i]);
      ++sharpness.scans;
    }
  }
  if (sharpness.scans < 2) {
    throw FileError(scans, "fewer than two scans have a pose");
  }
  sharpness.map = estimation.compute();
  sharpness.radius = parameters.radius;
  return sharpness;
}

Json toJson(const Sharpness& sharpness)
{
  const MapSharpness& map = sharpness.map;
  const bool any = map.points > 0;
  return {{"mean_map_entropy", any ? Json(map.mean_map_entropy) : Json()},
          {"mean_plane_variance_m2", any ? Json(map.mean_plane_variance) : Json()},
          {"spread_across_planes_m", any ? Json(map.spreadAcrossPlanes()) : Json()},
          {"points", map.points},
          {"scans", sharpness.scans},
          {"radius_m", sharpness.radius}};
}

Json toJson(const RestMetric& rest)
{
  return {{"wander_m", rest.wander},
          {"drift_m", rest.drift},
          {"jitter_rms_m", rest.jitter.translation.rms},
          {"jitter_max_m", rest.jitter.translation.max},
          {"wander_deg", rest.rotation_wander},
          {"drift_deg", rest.rotation_drift},
          {"jitter_rms_deg", rest.jitter.rotation.rms},
          {"jitter_max_deg", rest.jitter.rotation.max}};
}

std::string describe(const Sharpness& sharpness)
{
  const MapSharpness& map = sharpness.map;
  if (map.points == 0) {
    return formatted("%-22s none: no place was seen by two of %zu scans", "sharpness", sharpness.scans);
  }
  return formatted("%-22s mean map entropy %.4f   spread across planes %.4f m (mean plane variance %.3e m^2)",
                   "sharpness", map.mean_map_entropy, map.spreadAcrossPlanes(), map.mean_plane_variance) +
         formatted("\n%-22s %zu neighbourhoods of %g m in %zu scans", "", map.points, sharpness.radius,
                   sharpness.scans);
}

std::string describe(const RestMetric& rest)
{
  const auto line = [](const char* name, double wander, double drift, const ErrorStatistics& jitter, const char* unit) {
    return formatted("%-22s wander %.4f   drift %.4f   jitter rms %.4f   max %.4f %s", name, wander, drift, jitter.rms,
                     jitter.max, unit);
  };
  return line("at rest", rest.wander, rest.drift, rest.jitter.translation, "m") + "\n" +
         line("", rest.rotation_wander, rest.rotation_drift, rest.jitter.rotation, "deg");
}

}  // namespace pcl_floam::tools
