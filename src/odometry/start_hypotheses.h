/// \file start_hypotheses.h
/// The motions that a drive may have begun with, when its first two scans alone don't tell.
#pragma once

#include "odometry/motion_model.h"

#include <pcl_floam/filters/features.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/odometry/odometry_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <utility>
#include <vector>

namespace pcl_floam {

/// A motion that a drive may have begun with, and where that has led so far.
struct StartHypothesis {
  Vector6 twist = Vector6::Zero();  ///< per period, as it began
  MotionModel motion;
  KeyframeVoxelMap map;
  SE3 world_T_keyframe;  ///< last keyframe
  int keyframes = 0;
  bool keyframe = false;                 ///< whether the last scan is one
  RegistrationReport registration = {};  ///< of the last scan
  double explained = 0.0;                ///< features so far, each by as much as it fits
};

/// What every start has in common.
struct FirstScan {
  const FeatureSet& features;  ///< as measured
  SE3 pose;                    ///< at the instant of the parameters
  const MotionModel& motion;   ///< which does not know its velocity yet
};

/// The first scan, given its motion: its pose at the instant of the parameters stays what it was reported to be.
[[nodiscard]] StartHypothesis startWith(const Vector6& twist, const FirstScan& first,
                                        const OdometryParameters& parameters);

/// Follows several motions through the next scans, each with a map of its own, until it is plain which of them it was.
///
/// With few scan lines, two scans that are metres apart have hardly a surface in common, and traffic and the rings on
/// the road fit as well as the world does. A few scans on, the map of the true motion has filled, and more fits it. Of
/// 60 starts on simulated highways at 25 m/s (VLP-16 and HDL-32, seeds 31 to 36), 26 were lost without this, 1 is with
/// it.
class StartHypotheses {
public:
  /// The first one is the start that was found.
  void add(StartHypothesis start) { starts_.push_back(std::move(start)); }

  [[nodiscard]] bool areOpen() const { return starts_.size() > 1; }

  /// As the motion model's.
  void elapse(double periods);
  void setSweep(double fraction, bool has_times);
  void carryOn();

  /// Tracks a scan with each.
  /// \param motion        that the odometry itself has come to with the start that was found
  /// \param typical_range m, of the scan's points
  /// \return the start to go on from, which has taken in the scan, if it is another one than the odometry went on from;
  ///         else null. Then, or once enough scans were seen, none is open any more.
  [[nodiscard]] const StartHypothesis* track(const FeatureSet& measured, const MotionModel& motion,
                                             double typical_range, const OdometryParameters& parameters);

private:
  void dropThoseNearFound();
  [[nodiscard]] const StartHypothesis* decide(const MotionModel& motion) const;
  [[nodiscard]] const StartHypothesis* betterThanFound(double times) const;
  [[nodiscard]] bool isAlone(const StartHypothesis& start) const;

  std::vector<StartHypothesis> starts_;
  std::vector<StartHypothesis> chosen_;  ///< one at most
  int scans_ = 0;
};

}  // namespace pcl_floam
