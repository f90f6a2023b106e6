/// \file odometry_parameters.h
/// Every setting of the odometry, with its default.
#pragma once

#include <pcl_floam/filters/core/feature_parameters.h>
#include <pcl_floam/filters/core/pose_instant.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/core/sensor_model.h>
#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/map/core/keyframe_policy.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/odometry/core/odometry_engine.h>
#include <pcl_floam/registration/core/registration_parameters.h>

#include <cstdint>

namespace pcl_floam {

/// The ways to undo a sweep's distortion that the paper's ablation compares.
enum class CompensationMode : std::uint8_t {
  none,       ///< points are used as measured
  two_stage,  ///< the paper's: predicted motion before, optimised motion after the pose estimation
  iterative,  ///< LOAM's: compensated anew with every new estimate within the pose iterations
  /// The motion during the sweep is estimated together with the pose, under a constant-velocity prior; by features,
  /// which have no such prior, it is `iterative`.
  continuous
};

[[nodiscard]] const char* toString(CompensationMode mode);

/// Settings of \ref Odometry. The defaults are meant to fit every sensor and scene.
struct OdometryParameters {
  OdometryEngine engine = OdometryEngine::surfaces;
  /// Default "auto": scan lines where a scan has them, neighbourhoods in space otherwise. The engine `features` cannot
  /// do without scan lines.
  SensorModel sensor;
  ScanTimingSource timing_source = ScanTimingSource::automatic;
  /// Rotation in degrees of every point about p x z, towards +z: corrects a wrong vertical angle of the
  /// sensor's calibration. Default 0; KITTI's HDL-64 needs about 0.205. -10 to 10.
  double vertical_correction = 0.0;
  /// Seconds from one sweep to the next, >= 0; 0 takes it from the scans' stamps. Matters only to scans whose
  /// time field spans less than the period, and to gaps.
  double scan_period = 0.0;
  FeatureParameters features;
  CompensationMode compensation = CompensationMode::continuous;
  PoseInstant pose_instant = PoseInstant::end;  ///< of the poses given out
  RegistrationParameters registration;
  KeyframePolicy keyframe;
  MapParameters map;
  int threads = 1;  ///< 1 to 1024, or 0: all processors; the result does not depend on it
  /// Work of a start, by surfaces, that one scan bears beside its own, in registrations of a scan: other motions are
  /// followed, sought and tried, and the first scans are gone through once more from the last ones. What is more is
  /// left to the scans that follow, whose poses are provisional until then. 2 to 1000; counted, not timed, so that the
  /// result does not depend on the machine. Default 10: with less, poses stay provisional for longer; with more, scans
  /// of the start take longer. Where nothing has to keep pace, 1000 seeks all with the second scan.
  int start_effort = 10;
};

/// \throws std::invalid_argument naming the first setting that is out of its range.
void validate(const OdometryParameters& parameters);

}  // namespace pcl_floam
