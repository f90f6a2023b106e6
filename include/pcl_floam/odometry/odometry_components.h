/// \file odometry_components.h
/// Objects of one's own in place of the odometry's.
#pragma once

#include <pcl_floam/filters/core/scan_point.h>
#include <pcl_floam/map/core/keyframe_policy.h>
#include <pcl_floam/map/core/surface_map.h>
#include <pcl_floam/registration/core/pose_factor.h>

#include <functional>
#include <vector>

namespace pcl_floam {

/// What of \ref Odometry is replaced or added. What is empty stays as it is. The objects are shared by copies of an
/// odometry, and called from its threads, several at a time while several tracks are followed: they must not throw, and
/// what is no factor must give the same for the same input whenever it is asked.
struct OdometryComponents {
  /// What else is known of each pose (`world_T_sensor` in the middle of the sweep). Until it is settled how the sensor
  /// began to move, the pose may be that of another instant of the first sweep's motion: off by a part of a sweep.
  std::vector<PoseFactor::ConstPtr> factors;

  /// Which scans enter the map that is registered with. By default, by surfaces, those 0.3 cells or 0.1 rad apart; by
  /// features as OdometryParameters::keyframe says. By surfaces, of those of which the map explains at least half as
  /// much as usual, but for starts: while motions compete there, also all scans of a lidar without scan lines.
  KeyframeRule is_keyframe;

  /// Chooses the returns that are registered from those that may enter the map (engine `surfaces`). By default one of
  /// each cell. What is chosen keeps its laser, place and index; its run is found afterwards.
  /// \param[out] registered empty
  std::function<void(const std::vector<ScanPoint>& points, std::vector<ScanPoint>& registered)> select_points;

  /// In place of the pyramid of voxels (engine `surfaces`; edges have a map of their own): \ref SurfaceMap::makeEmpty
  /// is asked for every map.
  SurfaceMap::ConstPtr map;
};

}  // namespace pcl_floam
