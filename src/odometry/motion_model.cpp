#include "odometry/motion_model.h"

#include "odometry/sensor_axes.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// When a direction is lost from sight, its velocity is off by more than the registrations before tell: they were about
/// to lose it. In the other modes the velocity's covariance is a constant, and large enough.
constexpr double kVelocityErrorsPerVariance = 6.0;

}  // namespace

void MotionModel::begin(const SE3& pose)
{
  pose_ = tracked_pose_ = pose;
  tracked_twist_.reset();
  turn_ = SweepTurn();
  sweep_velocity_ = SweepVelocity();
  drift_ = UnseenDrift();
  pose_covariance_.setZero();
  periods_since_tracked_ = 0.0;
  assumeSweep(Vector6::Zero());
}

void MotionModel::elapse(double periods)
{
  periods_ = periods;
  periods_since_tracked_ += periods;
  const double factor = mode_ == CompensationMode::continuous ? kVelocityErrorsPerVariance : 1.0;
  const Matrix6 change = (periods_since_tracked_ * velocity_noise_.variance()).asDiagonal();
  drift_.carryOn(turned(pose_.rotation, factor * velocity_.covariance() + change), periods);
}

void MotionModel::setSweep(double fraction, bool has_times)
{
  sweep_fraction_ = fraction;
  has_times_ = has_times;
}

double MotionModel::compensatedFraction() const
{
  return mode_ != CompensationMode::none && has_times_ ? sweep_fraction_ : 0.0;
}

void MotionModel::setFirst(const SE3& first_pose, const Vector6& twist)
{
  velocity_.set(twist);
  sweep_velocity_.begin(twist);
  pose_ = tracked_pose_ = first_pose;
  periods_ = periods_since_tracked_;  // scans between may have told nothing
  assumeSweep(compensatedFraction() * twist);
  tracked_twist_ = compensatedFraction() > 0.0 ? std::optional<Vector6>(twist) : std::nullopt;
}

SweepModel MotionModel::sweepModel(const SE3& guess) const
{
  SweepModel sweep;
  sweep.reference = kReference;
  sweep.twist = compensatedFraction() * velocity_.twist();
  if (!velocity_.isKnown() || compensatedFraction() == 0.0 || periods_since_tracked_ <= 0.0) {
    return sweep;
  }
  if (mode_ == CompensationMode::iterative) {
    sweep.freedom = SweepFreedom::follows_pose;
    sweep.held_pose = tracked_pose_;
    sweep.sweep_per_motion = sweep_fraction_ / periods_since_tracked_;
  }
  if (mode_ == CompensationMode::continuous) {
    sweep.freedom = SweepFreedom::free;
    sweep.prior = velocity_noise_.prior(guess, sweep.twist, periods_since_tracked_, sweep_fraction_);
    if (tracked_twist_) {
      sweep.last_twist = sweep_fraction_ * *tracked_twist_;
      sweep.sweeps_since_last = std::max(1.0, periods_since_tracked_) / sweep_fraction_;
    }
  }
  return sweep;
}

Vector6 MotionModel::twistTo(const SE3& pose) const
{
  if (periods_since_tracked_ <= 0.0) {
    return velocity_.twist();
  }
  return log(tracked_pose_.inverse() * pose) / periods_since_tracked_;
}

/// Motion per period after the registration (Eq. 12a).
///
/// The motion between two poses is the velocity of half a period ago; the twist of the sweep is that of now, but
/// noisier. Their mean is the better prediction. That of turns goes half a period ahead with the acceleration, which
/// halves its error in the hand; along a corridor or a highway it would carry on what noise there is.
Vector6 MotionModel::measuredTwist(const RegistrationReport& registration) const
{
  if (!velocity_.isKnown()) {  // in a map made before: what was estimated is how far off the first guess was
    return Vector6::Zero();
  }
  Vector6 twist = twistTo(registration.target_T_source);
  if (sweepIsEstimated()) {
    twist = 0.5 * twist + 0.5 / sweep_fraction_ * registration.sweep_twist;
    twist.tail<3>() += 0.5 / (sweep_fraction_ * sweep_fraction_) * registration.sweep_acceleration.tail<3>();
  }
  return twist;
}

void MotionModel::update(const RegistrationReport& registration, const SE3& predicted, double typical_range)
{
  const SE3& estimated = registration.target_T_source;
  prediction_error_.observe(predicted.inverse() * estimated, typical_range);
  const Vector6 measured = measuredTwist(registration);
  updateSweep(registration, measured);
  if (periods_since_tracked_ > 0.0) {
    updateVelocity(measured, registration);
  }
  pose_ = tracked_pose_ = estimated;
  pose_covariance_ = registration.covariance;
  drift_.see(registration.weak_directions);
  periods_since_tracked_ = 0.0;
}

void MotionModel::updateSweep(const RegistrationReport& registration, const Vector6& measured)
{
  const bool was_known = velocity_.isKnown();
  if (mode_ != CompensationMode::continuous) {
    assumeSweep(compensatedFraction() * measured);
  } else {
    sweep_ = SweepMotion(registration.sweep_twist, kReference, registration.sweep_acceleration);
    refined_sweep_ = sweep_;
  }
  tracked_twist_.reset();
  if (!was_known || compensatedFraction() == 0.0) {
    turn_ = SweepTurn();
    sweep_velocity_ = SweepVelocity();
    return;
  }
  Vector6 twist = sweep_.twist() / sweep_fraction_;
  if (mode_ == CompensationMode::continuous && periods_since_tracked_ > 0.0) {
    const Vector6 between = twistTo(registration.target_T_source);
    refined_sweep_ = sweep_velocity_.refine(sweep_, poseCovarianceInSensorAxes(registration), sweep_fraction_, between,
                                            periods_since_tracked_);
    twist.tail<3>() = turn_.refine(twist.tail<3>(), between.tail<3>(), periods_since_tracked_);
  }
  tracked_twist_ = twist;
}

void MotionModel::updateVelocity(const Vector6& measured, const RegistrationReport& registration)
{
  if (!velocity_.isKnown()) {
    velocity_.set(measured);
    return;
  }
  if (mode_ != CompensationMode::continuous) {
    // The paper's way: there the sweep is compensated with this velocity, and must not lag behind.
    velocity_noise_.observe(measured - velocity_.twist(), periods_since_tracked_);
    velocity_.set(measured);
    return;
  }
  const Vector6 change = velocity_.observe(measured, poseCovarianceInSensorAxes(registration),
                                           velocity_noise_.variance(), periods_since_tracked_);
  velocity_noise_.observe(change, periods_since_tracked_);
}

void MotionModel::carryOn()
{
  pose_ = predictedPose();
  if (mode_ != CompensationMode::none) {
    // A blind scan has no times, but the sensor moves on.
    assumeSweep(sweep_fraction_ * velocity_.twist());
  }
}

void MotionModel::assumeSweep(const Vector6& twist)
{
  sweep_ = refined_sweep_ = SweepMotion(twist, kReference);
}

}  // namespace pcl_floam
