/// \file motion_model.h
/// Where the sensor is, how it moves, and how well that is known: from scan to scan.
#pragma once

#include "odometry/constant_velocity.h"
#include "odometry/sweep_turn.h"
#include "odometry/sweep_velocity.h"
#include "odometry/unseen_drift.h"

#include <pcl_floam/filters/motion_compensation_mode.h>
#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/registration/registration_report.h>
#include <pcl_floam/registration/sweep_model.h>

#include <optional>

namespace pcl_floam {

/// The instant of the sweep, as a fraction of it, at which the pipeline sees points and estimates poses.
///
/// At the middle an error of the assumed motion moves the sweep's two halves apart but not its pose; at the end it
/// moves the pose by half of it, which the next motion then takes up with the opposite sign. Measured, end against
/// middle: handheld VLP-16 4.8 against 3.2 cm, urban HDL-64 0.30 against 0.17 %, and LOAM's compensation oscillates.
inline constexpr double kReference = 0.5;

/// The motion of the sensor as the registrations tell it (Eq. 2, 3, 12). Every pose is the sensor's at \ref kReference
/// of its sweep, in the world.
class MotionModel {
public:
  explicit MotionModel(CompensationMode mode) : mode_(mode) {}

  /// The sensor stands at a pose, with nothing known of its motion.
  void begin(const SE3& pose);

  /// A scan comes, so many periods after the last one.
  void elapse(double periods);

  /// \param fraction  duration of the present sweep in periods
  /// \param has_times whether its points have times
  void setSweep(double fraction, bool has_times);

  /// Whether two poses have been seen.
  [[nodiscard]] bool isKnown() const { return velocity_.isKnown(); }

  /// Periods since the last tracked scan.
  [[nodiscard]] double periodsSinceTracked() const { return periods_since_tracked_; }

  /// The part of a period during which the sweep moves; 0 where that is not to be compensated.
  [[nodiscard]] double compensatedFraction() const;

  /// The first motion is found together with the first scan's pose, once there is a second scan.
  void setFirst(const SE3& first_pose, const Vector6& twist);

  /// Per period, as far as it is known.
  [[nodiscard]] const Vector6& twist() const { return velocity_.twist(); }

  /// Motion Estimation (Eq. 2).
  [[nodiscard]] SE3 predictedPose() const { return pose_ * velocity_.motion(periods_); }

  /// A bound of the prediction's error, m.
  [[nodiscard]] double predictionBound() const { return prediction_error_.bound(periods_since_tracked_); }

  /// Distortion Compensation, first stage: what the registration may assume of the motion (Eq. 3).
  [[nodiscard]] SweepModel sweepModel(const SE3& guess) const;

  /// Takes in a scan's registration (Eq. 12).
  /// \param predicted     pose that the registration began with
  /// \param typical_range m, of the scan's points
  void update(const RegistrationReport& registration, const SE3& predicted, double typical_range);

  /// The map takes in the scan at the present pose.
  void enterMap() { drift_.enterMap(); }

  /// Without a registration, the sensor goes on as before.
  void carryOn();

  [[nodiscard]] const SE3& pose() const { return pose_; }

  /// Of the last scan that was tracked.
  [[nodiscard]] const SE3& trackedPose() const { return tracked_pose_; }

  /// Motion during the present sweep, as it was registered or, without, as assumed.
  [[nodiscard]] const SweepMotion& sweep() const { return sweep_; }

  /// The pose at another instant of the sweep, with all that is known of the motion during it.
  [[nodiscard]] SE3 poseAt(double instant) const { return pose_ * refined_sweep_.at(instant); }

  /// Of the pose.
  [[nodiscard]] Matrix6 covariance() const { return pose_covariance_ + drift_.covariance(); }

private:
  /// Motion per period from the last tracked scan to a pose (Eq. 12a).
  [[nodiscard]] Vector6 twistTo(const SE3& pose) const;
  [[nodiscard]] Vector6 measuredTwist(const RegistrationReport& registration) const;
  void updateVelocity(const Vector6& measured, const RegistrationReport& registration);
  void updateSweep(const RegistrationReport& registration, const Vector6& measured);
  void assumeSweep(const Vector6& twist);

  [[nodiscard]] bool sweepIsEstimated() const
  {
    return mode_ == CompensationMode::continuous && compensatedFraction() > 0.0;
  }

  CompensationMode mode_;
  ConstantVelocity velocity_;
  PredictionError prediction_error_;
  VelocityNoise velocity_noise_;
  SweepTurn turn_;
  SweepVelocity sweep_velocity_;
  UnseenDrift drift_;
  SE3 pose_;                                   ///< last scan, tracked or predicted
  SE3 tracked_pose_;                           ///< last tracked scan
  Matrix6 pose_covariance_ = Matrix6::Zero();  ///< of the last registration
  double periods_ = 1.0;                       ///< from the last scan to this one
  double periods_since_tracked_ = 0.0;
  double sweep_fraction_ = 1.0;  ///< duration of the sweep in periods
  bool has_times_ = false;
  SweepMotion sweep_{Vector6::Zero(), kReference};
  SweepMotion refined_sweep_{Vector6::Zero(), kReference};
  std::optional<Vector6> tracked_twist_;  ///< per period, of the last sweep that was tracked with its times
};

}  // namespace pcl_floam
