/// \file track.h
/// One hypothesis of how the sensor has moved: a motion and the map that goes with it.
#pragma once

#include "map/voxel_pyramid.h"
#include "motion/motion_estimate.h"

#include <pcl_floam/filters/scan_points.h>
#include <pcl_floam/registration/registration_report.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// One sweep as a track takes it.
struct TrackedSweep {
  const std::vector<ScanPoint>* points = nullptr;  ///< all returns
  double periods = 1.0;                            ///< since the sweep before, > 0
  double sweep_fraction = 1.0;  ///< duration of the sweep in periods; 0 if its points are of one instant
};

/// The odometry of the surface engine: predict, register, update; points by space, a pyramid of voxels that
/// remembers lasers, a variance for each correspondence, one estimate of motion.
///
/// All lengths follow from the first scan: cells of the side that its returns fill some 2,000 of.
class Track {
public:
  explicit Track(int threads = 1) : threads_(threads) {}

  /// Registers the next sweep. The first one begins the map; its motion is found with the second.
  RegistrationReport step(const TrackedSweep& sweep);

  /// At the middle of the last sweep, seen from the first one's.
  [[nodiscard]] const SE3& pose() const { return motion_.pose(); }
  [[nodiscard]] const VoxelPyramid* map() const { return map_ ? &*map_ : nullptr; }

private:
  void begin(const TrackedSweep& sweep);
  RegistrationReport findFirstMotion(const TrackedSweep& sweep);
  RegistrationReport follow(const TrackedSweep& sweep);
  void insert(const std::vector<ScanPoint>& points, const SE3& pose, const Vector6& sweep_twist);
  [[nodiscard]] bool isKeyframe() const;

  int threads_;
  int sweeps_ = 0;
  double side_ = 0.0;  // m
  SpatialSampling sampling_;
  std::vector<ScanPoint> sample_;
  std::vector<ScanPoint> first_;
  double first_fraction_ = 1.0;
  std::optional<VoxelPyramid> map_;
  MotionEstimate motion_;
  SE3 keyframe_;
};

}  // namespace pcl_floam
