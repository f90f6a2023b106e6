/// \file start_hypotheses.h
/// The motions that a drive may have begun with, when its first two scans alone don't tell.
#pragma once

#include "odometry/motion_model.h"

#include <pcl_floam/filters/features.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/odometry/odometry_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// A motion that a drive may have begun with, and where that has led so far.
struct StartHypothesis {
  MotionModel motion;
  KeyframeVoxelMap map;
  SE3 world_T_keyframe;  ///< last keyframe
  int keyframes = 0;
  bool keyframe = false;                 ///< whether the last scan is one
  RegistrationReport registration = {};  ///< of the last scan
  double residual = 0.0;                 ///< m, root mean square of the last few scans
  std::vector<SE3> poses = {};           ///< since the pose that is given, at the instant of the parameters
};

/// What every start has in common.
struct FirstScan {
  FeatureSet features;  ///< as measured
  SE3 pose;             ///< that is given, at the instant of the parameters
  /// When the second scan has come, without a velocity yet.
  MotionModel motion;
  double periods_since_pose = 0.0;  ///< more than 0 if the scan at the given pose was given up
  /// When else there were scans, in periods since the pose: they could not be registered while no motion was known.
  std::vector<double> others = {};
};

/// A scan, and when it came.
struct NextScan {
  FeatureSet measured;          ///< none if nothing was seen
  double periods = 1.0;         ///< since the last one
  double sweep_fraction = 1.0;  ///< duration of the sweep in periods
  bool has_times = false;
  double typical_range = 1.0;  ///< m, of the points
  FeatureSet sample = {};      ///< those that are registered (spreadSample); filled in by \ref StartHypotheses

  [[nodiscard]] bool sawNothing() const { return measured.edges.empty() && measured.planes.empty(); }
};

/// The first scan, given the motion since its pose was.
[[nodiscard]] StartHypothesis startWith(const Vector6& twist, const FirstScan& first,
                                        const OdometryParameters& parameters);

/// Follows several motions through the next scans, each with a map of its own, until it is plain which of them it was.
///
/// With few scan lines, two scans that are metres apart have hardly a surface in common, and traffic and the rings on
/// the road fit as well as the world does. A few scans on, the map of the true motion fits best.
class StartHypotheses {
public:
  StartHypotheses() = default;

  /// \param found  start that the first two scans tell
  /// \param others motions that it may have been
  StartHypotheses(FirstScan first, StartHypothesis found, const std::vector<Vector6>& others,
                  const OdometryParameters& parameters);

  [[nodiscard]] bool areOpen() const { return !starts_.empty(); }

  /// A scan saw nothing: each goes on as before.
  void miss(double periods, const OdometryParameters& parameters);

  /// Tracks a scan with each; the second scan is the first of them.
  /// \return once enough scans were seen, when none is open any more: the start to go on from, which has taken in the
  ///         scan, if it is another one than was found
  [[nodiscard]] std::optional<StartHypothesis> track(NextScan scan, const OdometryParameters& parameters);

private:
  void followWithEach(NextScan scan, const OdometryParameters& parameters);
  void dropOthers();
  [[nodiscard]] const StartHypothesis* betterThanFound() const;
  [[nodiscard]] StartHypothesis onceMore(const StartHypothesis& start, const OdometryParameters& parameters) const;

  FirstScan first_{{}, SE3(), MotionModel(CompensationMode::none)};
  std::vector<NextScan> scans_;
  std::size_t seen_ = 0;                 ///< of the scans, those with features
  std::vector<StartHypothesis> starts_;  ///< the first is the one that was found
};

}  // namespace pcl_floam
