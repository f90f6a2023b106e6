#include "odometry/track.h"

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
/// How far off a pose may be that somebody gives, m and rad.
constexpr double kGivenOff = 3.0;
constexpr double kGivenTurned = 0.25;
/// Part of a sweep that points anywhere would have on surfaces of the map.
constexpr double kByChance = 0.1;

bool isFar(const SE3& keyframe, const SE3& pose, double side)
{
  const SE3 moved = keyframe.inverse() * pose;
  return moved.translation.norm() > kKeyframeSides * side || rotationAngle(moved.rotation) > kKeyframeTurn;
}

Matrix6 covarianceOf(double translation, double rotation)
{
  Vector6 variance;
  variance << Eigen::Vector3d::Constant(translation * translation), Eigen::Vector3d::Constant(rotation * rotation);
  return variance.asDiagonal();
}

/// Of a guess that may be so far off in all directions.
Matrix6 reachOf(double far, double far_turn)
{
  return covarianceOf(far / std::sqrt(3.0), far_turn / std::sqrt(3.0));
}

/// Distortion Compensation, first stage (Eq. 3 and 4).
SweepPlacement placementOf(CompensationMode mode)
{
  switch (mode) {
    case CompensationMode::continuous: return SweepPlacement::joint;
    case CompensationMode::iterative: return SweepPlacement::follows;
    default: return SweepPlacement::held;
  }
}

/// Of a pose that a single motion has led to, for so many periods: one that is not known at all.
Matrix12 oneMotion(double periods)
{
  constexpr double kRest = 1e-6;  // by how much it may be another at the end
  Eigen::Matrix<double, 12, 12> covariance = Eigen::Matrix<double, 12, 12>::Identity();
  covariance.topLeftCorner<6, 6>() *= periods * periods;
  covariance.topRightCorner<6, 6>().diagonal().setConstant(periods);
  covariance.bottomLeftCorner<6, 6>().diagonal().setConstant(periods);
  covariance.bottomRightCorner<6, 6>() *= 1.0 + kRest;
  return covariance;
}

/// How far a motion is from what was told of it, in its standard deviations.
double squaredError(const SE3& motion, const MotionHint& hint)
{
  const SE3 off = hint.last_T_now.inverse() * motion;
  Eigen::Matrix<double, 6, 1> error;
  error << off.translation, logSO3(off.rotation);
  return error.dot(Eigen::Matrix<double, 6, 6>(hint.covariance).ldlt().solve(error));
}

/// What fits no better than points anywhere would is no pose.
SurfaceRegistration unlessByChance(SurfaceRegistration found)
{
  if (found.report.hasConverged() && found.explained() < kByChance) {
    found.report.termination = Termination::too_few_correspondences;
  }
  return found;
}

bool isBetter(const SurfaceRegistration& a, const SurfaceRegistration& b)
{
  return a.report.hasConverged() && (!b.report.hasConverged() || a.evidence > b.evidence);
}

}  // namespace

void Track::beginMap()
{
  if (map_) {
    map_->clear();
  } else {
    map_.emplace(side_, settings_.horizon);
  }
}

SurfaceRegistration Track::findMotion(const Sweep& first, const Sweep& second, const FirstLook& look)
{
  constexpr double kTurnPerMetre = 0.02;  // rad: of a car in a bend
  SurfaceRegistration found;
  SE3 first_T_second = exp(second.periods * look.velocity);
  double far = look.far;
  for (int round = 0; round < look.rounds; ++round, far *= 0.5) {
    const Vector6 motion = log(first_T_second) / second.periods;
    beginMap();
    map_->insert(first, {SE3(), fractionOf(first) * motion});
    motion_ = MotionEstimate(SE3(), motion);
    motion_.predict(second.periods);
    SurfaceProblem problem = problemFor(second);
    problem.reach = reachOf(far, kTurnPerMetre * far);
    problem.prior.pose_counts = false;
    problem.prior.covariance = oneMotion(second.periods);
    problem.wants_evidence = problem.looks_for_weak = round + 1 == look.rounds;
    found = registerSurfaces(problem);
    if (!found.report.hasConverged()) {
      return found;
    }
    first_T_second = found.report.target_T_source;
  }
  evidence_ = found.evidence;
  if (second.hint) {
    evidence_ -= 0.5 * squaredError(first_T_second, *second.hint);
  }
  return found;
}

SurfaceRegistration Track::begin(const Sweep& first, const Sweep& second, const FirstLook& look)
{
  SurfaceRegistration found = findMotion(first, second, look);
  if (found.report.hasConverged()) {
    beginMap();
    map_->insert(first, {SE3(), fractionOf(first) / second.periods * log(found.report.target_T_source)});
    motion_.learnNothing();  // it was supposed, not predicted
    update(second, found);
    updateMap(second);
  }
  return found;
}

std::vector<bool> keyframesAmong(const std::vector<SE3>& poses, double side)
{
  std::vector<bool> keyframes;
  SE3 last;
  for (const SE3& pose : poses) {
    keyframes.push_back(keyframes.empty() || isFar(last, pose, side));
    last = keyframes.back() ? pose : last;
  }
  return keyframes;
}

void Track::begin(const std::vector<Sweep>& sweeps, const std::vector<SE3>& poses, const std::vector<bool>& keyframes)
{
  constexpr double kKnown = 0.01;  // m and rad
  beginMap();
  Vector6 velocity = Vector6::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t next = std::max<std::size_t>(i, 1);
    velocity = log(poses[next - 1].inverse() * poses[next]) / sweeps[next].periods;
    pose_ = {poses[i], fractionOf(sweeps[i]) * velocity};
    if (i == 0) {
      motion_ = MotionEstimate(poses[i], log(poses[0].inverse() * poses[1]) / sweeps[1].periods);
      motion_.place(poses[i], covarianceOf(kKnown, kKnown));
    } else {
      motion_.predict(sweeps[i].periods);
      motion_.correct(poses[i], covarianceOf(kKnown, kKnown));
    }
    if (keyframes[i]) {
      map_->insert(sweeps[i], pose_);
      keyframe_ = poses[i];
    }
  }
}

SurfaceRegistration Track::begin(const Sweep& sweep, TrackMap map, const SE3& guess, bool keeps_map)
{
  map_.emplace(std::move(map));
  keeps_map_ = keeps_map;
  keyframe_ = guess;
  settle(sweep, guess, kGivenOff, kGivenTurned);
  SurfaceRegistration found = unlessByChance(registerSurfaces(problemFor(sweep)));
  if (found.report.hasConverged()) {
    update(sweep, found);
    updateMap(sweep);
  }
  return found;
}

SurfaceRegistration Track::step(const Sweep& sweep, Rivals rivals)
{
  const MotionEstimate before = motion_;
  const int waited_before = sweeps_to_wait_;
  is_keyframe_ = false;
  predict(sweep);
  SurfaceRegistration registration = registerPredicted(sweep, rivals);
  if (registration.report.hasConverged()) {
    if (rivals != Rivals::none) {
      judge(registration);
    }
    update(sweep, registration);
  } else {
    motion_ = before;
    sweeps_to_wait_ = waited_before;
  }
  return registration;
}

/// A pose that the map does not bear out may be due to a prediction that was farther off than could be known.
SurfaceRegistration Track::registerPredicted(const Sweep& sweep, Rivals rivals)
{
  constexpr double kLook = 3.0;  // standard deviations, while it is not decided how the sensor began to move
  SurfaceProblem problem = problemFor(sweep);
  problem.wants_evidence = rivals != Rivals::none;
  if (rivals == Rivals::motions) {
    problem.open = open_;
    problem.reach *= kLook * kLook;
  }
  SurfaceRegistration found = registerSurfaces(problem);
  if (rivals != Rivals::motions && found.explained() < kBorneOut && seek(sweep, found)) {
    SurfaceProblem again = problemFor(sweep);
    again.wants_evidence = problem.wants_evidence;
    found = registerSurfaces(again);
  }
  return unlessByChance(std::move(found));
}

/// Motion Estimation (Eq. 2).
void Track::predict(const Sweep& sweep)
{
  velocity_before_ = motion_.velocity();
  periods_between_ = std::max(1.0, sweep.periods);  // over less, a difference of velocities is no acceleration
  motion_.predict(sweep.periods, sweep.hint, sweep.periods_error);
  if (is_placed_) {
    settle(sweep, pose_.middle, kGivenOff, kGivenTurned);
  }
}

/// Goes to where the sweep is explained best, if that is better than from the prediction. After a time without scans it
/// may be anywhere around where it was, and where it would be by now, turned by any angle about its axis.
/// \param found from the prediction
/// \return whether it is elsewhere
bool Track::seek(const Sweep& sweep, const SurfaceRegistration& found)
{
  constexpr double kLong = 3.5;  // periods: a car's motion is known for longer, a hand's is not
  constexpr int kTurns = 18;
  constexpr double kReach = 1.0;   // m
  constexpr double kTurned = 0.4;  // rad
  if (sweep.periods <= kLong) {
    return found.explained() >= kByChance && goToBest(sweep, {motion_.pose()}, kGivenOff, kGivenTurned);
  }
  std::vector<SE3> guesses;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Eigen::AngleAxisd about_axis(2.0 * M_PI * turn / kTurns, Eigen::Vector3d::UnitZ());
    for (const SE3& place : {pose_.middle, motion_.pose()}) {
      guesses.emplace_back(place.rotation * about_axis.toRotationMatrix(), place.translation);
    }
  }
  return goToBest(sweep, guesses, kReach, kTurned);
}

bool Track::goToBest(const Sweep& sweep, const std::vector<SE3>& guesses, double far, double far_turn)
{
  SurfaceProblem as_predicted = problemFor(sweep);
  as_predicted.wants_evidence = true;
  SurfaceRegistration best = registerSurfaces(as_predicted);
  bool is_elsewhere = false;
  for (const SE3& guess : guesses) {
    const SurfaceRegistration found = registerFrom(sweep, guess, far, far_turn);
    if (isBetter(found, best)) {
      best = found;
      is_elsewhere = true;
    }
  }
  if (is_elsewhere) {
    sweeps_to_wait_ = kSweepsUntilKnown;
    settle(sweep, best.report.target_T_source, far, far_turn);
  }
  return is_elsewhere;
}

/// Places the sensor where a sweep fits, from a guess that is far off, looking less and less far. What was known of the
/// velocity tells nothing there.
void Track::settle(const Sweep& sweep, const SE3& guess, double far, double far_turn)
{
  constexpr int kRounds = 4;
  SE3 place = guess;
  for (int round = 0; round < kRounds; ++round, far *= 0.5, far_turn *= 0.5) {
    place = registerFrom(sweep, place, far, far_turn).report.target_T_source;  // that failed: where it began
  }
  motion_ = MotionEstimate();
  motion_.place(place, covarianceOf(far, far_turn));
  periods_between_ = 0.0;
}

void Track::place(const SE3& pose)
{
  motion_ = MotionEstimate(pose);
  pose_ = {pose};
  is_placed_ = true;
}

void Track::forgetAlong(const std::vector<WeakDirection>& directions, double periods)
{
  for (const WeakDirection& weak : directions) {
    motion_.forgetAlong(weak.direction.head<3>(), periods);
  }
}

SurfaceRegistration Track::registerFrom(const Sweep& sweep, const SE3& guess, double far, double far_turn) const
{
  SurfaceProblem problem = problemFor(sweep);
  problem.prior.pose = guess;
  problem.prior.velocity.setZero();
  problem.prior.covariance = MotionEstimate(guess).covariance();
  problem.prior.periods_between = 0.0;
  problem.prior.pose_counts = false;
  problem.reach = reachOf(far, far_turn);
  problem.wants_evidence = true;
  return registerSurfaces(problem);
}

SurfaceProblem Track::problemFor(const Sweep& sweep) const
{
  SurfaceProblem problem;
  problem.scan = {&sweep.sample, &map_->space};
  problem.edges = {&sweep.edges, &map_->edges};
  problem.prior.pose = motion_.pose();
  problem.prior.velocity = motion_.velocity();
  problem.prior.velocity_before = velocity_before_;
  problem.prior.periods_between = periods_between_;
  problem.prior.covariance = motion_.covariance();
  problem.prior.fraction = fractionOf(sweep);
  problem.reach = motion_.poseCovariance();
  problem.placement = placementOf(settings_.compensation);
  problem.locked = settings_.locked;
  problem.threads = settings_.threads;
  problem.room = &room_;
  return problem;
}

/// What a hypothesis is worth: how it explains the last sweeps, and how little the sensor must have been pushed about.
/// What was long ago counts less, since a moving sensor's map says little at first, and a resting one's all it ever
/// will.
void Track::judge(const SurfaceRegistration& registration)
{
  constexpr double kKept = 0.8;  // of the evidence, from sweep to sweep
  const SE3& found = registration.report.target_T_source;
  Eigen::Matrix<double, 6, 1> off;
  off << found.translation - motion_.pose().translation, logSO3(found.rotation * motion_.pose().rotation.transpose());
  const Eigen::Matrix<double, 6, 6> expected = motion_.poseCovariance() + registration.report.covariance;
  evidence_ = kKept * evidence_ + registration.evidence - 0.5 * off.dot(expected.ldlt().solve(off));
}

/// Distortion Compensation Update (Eq. 12).
void Track::update(const Sweep& sweep, const SurfaceRegistration& registration)
{
  const SE3 last = pose_.middle;
  motion_.update(registration.report.target_T_source, registration.velocity, registration.posterior);
  pose_ = {motion_.pose(), registration.report.sweep_twist, registration.report.sweep_acceleration};
  if (settings_.compensation == CompensationMode::two_stage) {
    pose_.twist = fractionOf(sweep) / sweep.periods * log(last.inverse() * pose_.middle);
  }
  sweeps_to_wait_ = is_placed_ ? kSweepsUntilKnown : sweeps_to_wait_;
  is_placed_ = false;
  is_keyframe_ = sweeps_to_wait_ == 0 && keeps_map_ && isFar(keyframe_, pose_.middle, side_);
  sweeps_to_wait_ = std::max(0, sweeps_to_wait_ - 1);
}

/// Mapping Building.
void Track::updateMap(const Sweep& sweep, bool takes_it)
{
  if (takes_it) {
    map_->insert(sweep, pose_);
    keyframe_ = pose_.middle;
  }
  is_keyframe_ = false;
}

}  // namespace pcl_floam
