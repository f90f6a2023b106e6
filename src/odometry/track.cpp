#include "odometry/track.h"

#include "common/perturbation.h"

#include <algorithm>
#include <utility>

namespace pcl_floam {

namespace {

/// How far off a pose may be that somebody gives.
constexpr Doubt kGiven = {3.0, 0.25};
/// Part of a sweep that points anywhere would have on surfaces of the map.
constexpr double kByChance = 0.1;

/// Distortion Compensation, first stage (Eq. 3 and 4).
SweepPlacement placementOf(CompensationMode mode)
{
  switch (mode) {
    case CompensationMode::continuous: return SweepPlacement::joint;
    case CompensationMode::iterative: return SweepPlacement::follows;
    default: return SweepPlacement::held;
  }
}

/// Whether the sensor may be anywhere by now.
bool isLong(const Sweep& sweep)
{
  constexpr double kLong = 3.5;  // periods: a car's motion is known for longer, a hand's is not
  return sweep.periods > kLong;
}

/// What fits no better than points anywhere would is no pose, unless the map has never explained more.
SurfaceRegistration unlessByChance(SurfaceRegistration found, const UsualExplanation& usual)
{
  const double explained = found.explained();
  if (found.report.hasConverged() && explained < kByChance && !usual.isMet(explained)) {
    found.report.termination = Termination::too_few_correspondences;
  }
  return found;
}

/// Whether a sweep enters the map that a track registers with.
/// \param is_new it shows what the map has not seen, though the sensor has not moved
bool becomesKeyframe(const SE3& last_keyframe, const SE3& pose, const TrackSettings& settings, bool is_new = false)
{
  constexpr double kSides = 0.3;  // of the finest cells: much nearer, a sweep tells the map nothing new
  constexpr double kTurn = 0.1;   // rad
  if (settings.components.is_keyframe) {
    return settings.components.is_keyframe(last_keyframe, pose);
  }
  const SE3 moved = last_keyframe.inverse() * pose;
  return is_new || moved.translation.norm() > kSides * settings.side || rotationAngle(moved.rotation) > kTurn;
}

}  // namespace

SurfaceRegistration Track::begin(const Sweep& sweep, TrackMap map, const SE3& guess, bool keeps_map)
{
  map_.emplace(std::move(map));
  keeps_map_ = keeps_map;
  explanation_ = UsualExplanation::ofPriorMap();
  keyframe_ = guess;
  settle(sweep, guess, kGiven);
  SurfaceRegistration found = unlessByChance(registerSurfaces(problemFor(sweep)), explanation_);
  if (found.report.hasConverged()) {
    update(sweep, found, Rivals::none);
    updateMap(sweep);
  }
  return found;
}

SurfaceRegistration Track::step(const Sweep& sweep, Rivals rivals)
{
  constexpr double kKept = 1.0 - 1.0 / kRememberedSweeps;  // of the evidence, from sweep to sweep
  const MotionEstimate before = motion_;
  const int waited_before = sweeps_to_wait_;
  is_keyframe_ = false;
  predict(sweep);
  SurfaceRegistration registration = registerPredicted(sweep, rivals);
  if (registration.report.hasConverged()) {
    if (rivals != Rivals::none) {
      // What was long ago counts less, since a moving sensor's map says little at first, and a resting one's all it
      // ever will.
      evidence_ = kKept * evidence_ + likelihoodOf(registration, motion_.pose(), motion_.poseCovariance());
    }
    update(sweep, registration, rivals);
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
  problem.evidence = rivals == Rivals::none ? Evidence::none : Evidence::total;
  if (rivals == Rivals::motions) {
    problem.is_rival = true;
    problem.looks_for_patterns = false;
    problem.evidence = Evidence::of_points;
    problem.guess_covariance *= kLook * kLook;
  }
  SurfaceRegistration found =
      rivals == Rivals::motions ? registerSurfaces(problem) : registerAround(problem, settings_.side);
  if ((rivals != Rivals::motions || isLong(sweep)) && !explanation_.isMet(found.explained()) && seek(sweep, found)) {
    SurfaceProblem again = problemFor(sweep);
    again.evidence = problem.evidence;
    again.looks_for_patterns = rivals != Rivals::motions;
    found = registerSurfaces(again);
  }
  return unlessByChance(std::move(found), explanation_);
}

/// Motion Estimation (Eq. 2).
void Track::predict(const Sweep& sweep)
{
  velocity_before_ = motion_.velocity();
  periods_between_ = std::max(1.0, sweep.periods);  // over less, a difference of velocities is no acceleration
  motion_.predict(sweep.periods, sweep.hint, sweep.periods_error);
  hinted_.setZero();
  if (sweep.hint) {
    hinted_ = inverseOf(propagated(turnOf(motion_.pose().rotation), sweep.hint->covariance));
  }
  if (is_placed_) {
    settle(sweep, pose_.middle, kGiven);
  }
}

/// Goes to where the sweep is explained best, if that is better than from the prediction. After a time without scans it
/// may be anywhere around where it was, and where it would be by now, turned by any angle about its axis.
/// \param found from the prediction
/// \return whether it is elsewhere
bool Track::seek(const Sweep& sweep, const SurfaceRegistration& found)
{
  constexpr Doubt kAround = {1.0, 0.4};
  const bool is_anywhere = isLong(sweep);
  if (!is_anywhere && found.explained() < kByChance) {
    return false;
  }
  const Doubt doubt = is_anywhere ? kAround : kGiven;
  const auto guesses = is_anywhere ? anyTurnOf({pose_.middle, motion_.pose()}) : std::vector<SE3>{motion_.pose()};
  const std::optional<SE3> place = betterPlace(problemFor(sweep), settings_.side, guesses, doubt);
  if (place) {
    sweeps_to_wait_ = kSweepsUntilKnown;
    settle(sweep, *place, doubt);
  }
  return place.has_value();
}

/// Places the sensor where a sweep fits, from a guess that is far off.
void Track::settle(const Sweep& sweep, const SE3& guess, const Doubt& doubt)
{
  const Place place = settledPlace(problemFor(sweep), guess, doubt);
  motion_ = MotionEstimate();
  motion_.place(place.pose, covarianceOf(place.doubt));
  hinted_.setZero();
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

SurfaceProblem Track::problemFor(const Sweep& sweep) const
{
  SurfaceProblem problem;
  problem.scan = {&sweep.sample, &map_->space()};
  problem.edges = {&sweep.edges, &map_->edges()};
  problem.factors = &sweep.factors;
  problem.prior.pose = motion_.pose();
  problem.prior.velocity = motion_.velocity();
  problem.prior.velocity_before = velocity_before_;
  problem.prior.periods_between = periods_between_;
  problem.prior.covariance = motion_.covariance();
  problem.prior.hinted = hinted_;
  problem.prior.fraction = fractionOf(sweep);
  problem.guess_covariance = motion_.poseCovariance();
  problem.placement = placementOf(settings_.compensation);
  problem.locked = settings_.locked;
  problem.threads = settings_.threads;
  problem.looks_for_patterns = true;
  problem.room = &room_;
  return problem;
}

/// Distortion Compensation Update (Eq. 12).
void Track::update(const Sweep& sweep, const SurfaceRegistration& registration, Rivals rivals)
{
  const SE3 last = pose_.middle;
  motion_.update(registration.report.target_T_source, registration.velocity, registration.posterior);
  pose_ = {motion_.pose(), registration.report.sweep_twist, registration.report.sweep_acceleration};
  if (settings_.compensation == CompensationMode::two_stage) {
    pose_.twist = fractionOf(sweep) / sweep.periods * log(last.inverse() * pose_.middle);
  }
  sweeps_to_wait_ = is_placed_ ? kSweepsUntilKnown : sweeps_to_wait_;
  is_placed_ = false;
  if (rivals == Rivals::motions) {
    explanation_.takeUnjudged(registration.explained());
  } else {
    explanation_.take(registration.explained());
  }
  // Of motions that compete none must explain more only because a sensor that moves less has less in its map.
  const bool is_new = rivals == Rivals::motions && sweep.is_pattern_new;
  is_keyframe_ = sweeps_to_wait_ == 0 && keeps_map_ && becomesKeyframe(keyframe_, pose_.middle, settings_, is_new);
  sweeps_to_wait_ = std::max(0, sweeps_to_wait_ - 1);
}

/// Mapping Building.
void Track::updateMap(const Sweep& sweep, bool takes_it)
{
  if (takes_it) {
    insert(sweep, pose_);
  }
  is_keyframe_ = false;
}

std::vector<bool> keyframesAmong(const std::vector<SweepPose>& poses, const TrackSettings& settings)
{
  std::vector<bool> keyframes;
  SE3 last;
  for (const SweepPose& pose : poses) {
    keyframes.push_back(keyframes.empty() || becomesKeyframe(last, pose.middle, settings));
    last = keyframes.back() ? pose.middle : last;
  }
  return keyframes;
}

}  // namespace pcl_floam
