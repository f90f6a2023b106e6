#include "odometry/track.h"

#include "registration/sweep_points.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// A keyframe, in sides of the finest cells and in rad.
constexpr double kKeyframeSides = 0.3;
constexpr double kKeyframeTurn = 0.1;
/// Standard deviations that a registration begins with.
constexpr double kLook = 3.0;

Matrix6 covarianceOf(double translation, double rotation)
{
  Vector6 variance;
  variance << Eigen::Vector3d::Constant(translation * translation), Eigen::Vector3d::Constant(rotation * rotation);
  return variance.asDiagonal();
}

void insertInto(VoxelPyramid& map, const std::vector<ScanPoint>& points, const MovingSensor& sensor)
{
  map.beginKeyframe();
  for (const ScanPoint& point : points) {
    map.insert(sensor.at(point), point.laser);
  }
}

}  // namespace

TrackMap::TrackMap(double side, const TrackSettings& settings)
    : space(side), edges(side, SurfaceShapes::lines), horizon(settings.horizon)
{
}

void TrackMap::insert(const Sweep& sweep, const SweepPose& pose)
{
  const MovingSensor sensor(pose.middle, pose.twist);
  insertInto(space, sweep.dense, sensor);
  insertInto(edges, sweep.edges, sensor);
  space.crop(pose.middle.translation, horizon);
  edges.crop(pose.middle.translation, horizon);
}

SurfaceRegistration Track::begin(const Sweep& first, const Sweep& second, const Vector6& velocity, double far,
                                 int rounds)
{
  constexpr double kTurnPerMetre = 0.02;  // rad: of a car in a bend
  SurfaceRegistration found;
  SE3 first_T_second = exp(second.periods * velocity);
  for (int round = 0; round < rounds; ++round, far *= 0.5) {
    const Vector6 motion = log(first_T_second) / second.periods;
    map_.emplace(side_, settings_);
    map_->insert(first, {SE3(), first.fraction * motion});
    SurfaceProblem problem = problemFor(second);
    problem.guess = first_T_second;
    problem.guess_covariance =
        covarianceOf(far / (kLook * std::sqrt(3.0)), kTurnPerMetre * far / (kLook * std::sqrt(3.0)));
    problem.guess_is_prior = false;
    problem.sweep.twist = second.fraction * motion;
    problem.sweep.gain = second.fraction / second.periods * Matrix6(Matrix6::Identity());
    problem.wants_evidence = round + 1 == rounds;
    found = registerSurfaces(problem);
    if (!found.report.hasConverged()) {
      return found;
    }
    first_T_second = found.report.target_T_source;
  }
  const Vector6 motion = log(first_T_second) / second.periods;
  map_.emplace(side_, settings_);
  map_->insert(first, {SE3(), first.fraction * motion});
  motion_ = MotionEstimate(SE3(), motion);
  motion_.predict(second.periods);
  found.report.sweep_twist = second.fraction * motion;
  evidence_ = found.evidence / kResidualsPerIndependentOne;
  update(second, found);
  return found;
}

void Track::begin(const std::vector<Sweep>& sweeps, const std::vector<SE3>& poses)
{
  constexpr double kKnown = 0.01;  // m and rad
  map_.emplace(side_, settings_);
  Vector6 velocity = Vector6::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t next = std::max<std::size_t>(i, 1);
    velocity = log(poses[next - 1].inverse() * poses[next]) / sweeps[next].periods;
    pose_ = {poses[i], sweeps[i].fraction * velocity};
    if (i == 0) {
      motion_ = MotionEstimate(poses[i], log(poses[0].inverse() * poses[1]) / sweeps[1].periods);
      motion_.place(poses[i], covarianceOf(kKnown, kKnown));
    } else {
      motion_.predict(sweeps[i].periods);
      motion_.correct(poses[i], covarianceOf(kKnown, kKnown), covarianceOf(kKnown, kKnown));
    }
    if (i == 0 || isKeyframe()) {
      map_->insert(sweeps[i], pose_);
      keyframe_ = poses[i];
    }
  }
}

SurfaceRegistration Track::begin(const Sweep& sweep, TrackMap map, const SE3& guess, bool keeps_map)
{
  constexpr double kFar = 3.0;      // m
  constexpr double kTurned = 0.25;  // rad
  constexpr int kRounds = 4;
  map_.emplace(std::move(map));
  keeps_map_ = keeps_map;
  keyframe_ = guess;
  SurfaceRegistration found;
  found.report.target_T_source = guess;
  double part = 1.0;
  for (int round = 0; round < kRounds; ++round, part *= 0.5) {
    found = registerFrom(sweep, found.report.target_T_source, part * kFar, part * kTurned);
  }
  motion_ = MotionEstimate(guess);
  motion_.place(guess, covarianceOf(kFar, kTurned));
  if (found.report.hasConverged()) {
    update(sweep, found);
  }
  return found;
}

SurfaceRegistration Track::step(const Sweep& sweep, bool is_judged)
{
  const MotionEstimate before = motion_;
  predict(sweep);
  SurfaceProblem problem = problemFor(sweep);
  problem.wants_evidence = is_judged;
  SurfaceRegistration registration = registerSurfaces(problem);
  if (registration.report.hasConverged()) {
    if (is_judged) {
      judge(registration);
    }
    update(sweep, registration);
  } else {
    motion_ = before;
  }
  return registration;
}

/// Motion Estimation (Eq. 2).
void Track::predict(const Sweep& sweep)
{
  constexpr double kLong = 3.5;  // periods: a car's motion is known for longer, a hand's is not
  motion_.predict(sweep.periods);
  if (sweep.periods > kLong) {
    seekAllAround(sweep);
  }
}

/// After a time without scans: where the sensor was, and where it would be by now, turned by any angle about its axis.
void Track::seekAllAround(const Sweep& sweep)
{
  constexpr int kTurns = 18;
  constexpr int kUntilKnown = 3;   // sweeps until the velocity is known again
  constexpr double kReach = 1.0;   // m
  constexpr double kTurned = 0.4;  // rad
  SurfaceProblem as_predicted = problemFor(sweep);
  as_predicted.wants_evidence = true;
  SurfaceRegistration best = registerSurfaces(as_predicted);
  bool is_elsewhere = !best.report.hasConverged();
  for (int turn = 0; turn < kTurns; ++turn) {
    const Eigen::AngleAxisd about_axis(2.0 * M_PI * turn / kTurns, Eigen::Vector3d::UnitZ());
    for (const SE3& place : {pose_.middle, motion_.pose()}) {
      const SE3 guess(place.rotation * about_axis.toRotationMatrix(), place.translation);
      const SurfaceRegistration found = registerFrom(sweep, guess, kReach, kTurned);
      if (found.report.hasConverged() && (!best.report.hasConverged() || found.evidence > best.evidence)) {
        best = found;
        is_elsewhere = true;
      }
    }
  }
  if (is_elsewhere && best.report.hasConverged()) {
    motion_ = MotionEstimate();  // the velocity of that long ago tells nothing
    sweeps_to_wait_ = kUntilKnown;
    motion_.place(best.report.target_T_source, covarianceOf(0.1 * kReach, 0.1 * kTurned));
  }
}

SurfaceRegistration Track::registerFrom(const Sweep& sweep, const SE3& guess, double far, double far_turn) const
{
  SurfaceProblem problem = problemFor(sweep);
  problem.guess = guess;
  problem.guess_covariance = covarianceOf(far / (kLook * std::sqrt(3.0)), far_turn / (kLook * std::sqrt(3.0)));
  problem.guess_is_prior = false;
  problem.sweep = {};
  problem.wants_evidence = true;
  return registerSurfaces(problem);
}

SurfaceProblem Track::problemFor(const Sweep& sweep) const
{
  SurfaceProblem problem;
  problem.scan = {&sweep.sample, &map_->space};
  problem.edges = {&sweep.edges, &map_->edges};
  problem.guess = motion_.pose();
  problem.guess_covariance = motion_.poseCovariance();
  problem.sweep = sweepDependence(sweep);
  problem.locked = settings_.locked;
  problem.threads = settings_.threads;
  return problem;
}

/// Distortion Compensation, first stage (Eq. 3 and 4): with the motion that was predicted; or with what the pose makes
/// of it.
SweepDependence Track::sweepDependence(const Sweep& sweep) const
{
  SweepDependence dependence;
  dependence.twist = sweep.fraction * motion_.velocity();
  if (settings_.compensation == CompensationMode::iterative) {
    dependence.twist = sweep.fraction / sweep.periods * log(pose_.middle.inverse() * motion_.pose());
    dependence.gain = sweep.fraction / sweep.periods * Matrix6(Matrix6::Identity());
  } else if (settings_.compensation == CompensationMode::continuous) {
    dependence.gain = sweep.fraction * motion_.velocityPerPose();
  }
  return dependence;
}

/// What a hypothesis is worth: how it explains the sweep, and how little the sensor must have been pushed about.
void Track::judge(const SurfaceRegistration& registration)
{
  const SE3& found = registration.report.target_T_source;
  Eigen::Matrix<double, 6, 1> off;
  off << found.translation - motion_.pose().translation, logSO3(found.rotation * motion_.pose().rotation.transpose());
  const Eigen::Matrix<double, 6, 6> expected =
      motion_.poseCovariance() + kResidualsPerIndependentOne * registration.posterior;
  evidence_ += registration.evidence / kResidualsPerIndependentOne - 0.5 * off.dot(expected.ldlt().solve(off));
}

/// Mapping Building & Distortion Compensation Update (Eq. 12).
void Track::update(const Sweep& sweep, const SurfaceRegistration& registration)
{
  const SE3 last = pose_.middle;
  const Matrix6 noise = kResidualsPerIndependentOne * registration.posterior;
  motion_.correct(registration.report.target_T_source, registration.posterior, noise);
  pose_ = {motion_.pose(), registration.report.sweep_twist};
  if (settings_.compensation == CompensationMode::two_stage) {
    pose_.twist = sweep.fraction / sweep.periods * log(last.inverse() * pose_.middle);
  }
  if (sweeps_to_wait_ > 0) {
    --sweeps_to_wait_;
  } else if (keeps_map_ && isKeyframe()) {
    map_->insert(sweep, pose_);
    keyframe_ = pose_.middle;
  }
}

bool Track::isKeyframe() const
{
  const SE3 moved = keyframe_.inverse() * pose_.middle;
  return moved.translation.norm() > kKeyframeSides * side_ || rotationAngle(moved.rotation) > kKeyframeTurn;
}

}  // namespace pcl_floam
