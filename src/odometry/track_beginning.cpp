// How a track begins: with the motion that two sweeps share, or with sweeps whose poses are known.
#include "odometry/track.h"

#include <utility>

namespace pcl_floam {

namespace {

/// Of a pose that a single motion has led to, for so many periods: hardly known. Its standard
/// deviation is a metre and a radian a period: what tells anything at all outweighs it.
Matrix12 oneMotion(double periods)
{
  constexpr double kRest = 1e-6;  // by how much it may be another at the end
  const Matrix6 one = Matrix6::Identity();
  return inBlocks(periods * periods * one, periods * one, periods * one, (1.0 + kRest) * one);
}

}  // namespace

void Track::beginMap()
{
  if (map_) {
    return map_->clear();
  }
  map_.emplace(settings_);
}

SurfaceRegistration Track::findMotion(const Sweep& first, const Sweep& second, const FirstLook& look)
{
  constexpr double kTurnPerMetre = 0.02;  // rad: of a car in a bend
  constexpr int kOfARound = 3;            // iterations: the next round's map is of what they have found
  SurfaceRegistration found;
  SE3 first_T_second = exp(second.periods * look.velocity);
  double far = look.far;
  for (int round = 0; round < look.rounds; ++round, far *= 0.5) {
    const Vector6 motion = log(first_T_second) / second.periods;
    beginMap();
    map_->insert(first, {SE3(), fractionOf(first) * motion});
    motion_ = MotionEstimate(SE3(), look.rests ? Vector6(Vector6::Zero()) : look.velocity);
    motion_.predict(second.periods);
    SurfaceProblem problem = problemFor(second);
    problem.begins_off << first_T_second.translation - problem.prior.pose.translation,
        logSO3(first_T_second.rotation * problem.prior.pose.rotation.transpose());
    problem.guess_covariance = guessCovarianceOf({far, kTurnPerMetre * far});
    problem.prior.covariance = oneMotion(second.periods);
    const bool is_last = round + 1 == look.rounds;
    problem.evidence = is_last ? Evidence::total : Evidence::none;
    problem.looks_for_patterns = false;  // of many motions one is followed, and the next sweeps tell what holds that
    problem.max_iterations = is_last ? problem.max_iterations : kOfARound;
    found = registerSurfaces(problem);
    if (!found.report.hasConverged()) {
      return found;
    }
    first_T_second = found.report.target_T_source;
  }
  evidence_ = found.evidence;
  if (second.hint) {
    const SE3 off = second.hint->last_T_now.inverse() * first_T_second;
    Vector6 error;
    error << off.translation, logSO3(off.rotation);
    evidence_ -= 0.5 * squaredDeviations(error, second.hint->covariance);
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
    update(second, found, Rivals::motions);
    updateMap(second);
  }
  return found;
}

void Track::begin(const std::vector<Sweep>& sweeps, const std::vector<SweepPose>& poses,
                  const std::vector<bool>& keyframes)
{
  constexpr Doubt kKnown = {0.01, 0.01};
  beginMap();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    pose_ = poses[i];
    if (i == 0) {
      motion_ = MotionEstimate(pose_.middle, log(pose_.middle.inverse() * poses[1].middle) / sweeps[1].periods);
      motion_.place(pose_.middle, covarianceOf(kKnown));
    } else {
      motion_.predict(sweeps[i].periods);
      motion_.correct(pose_.middle, covarianceOf(kKnown));
    }
    if (keyframes[i]) {
      insert(sweeps[i], pose_);
    }
  }
}

void Track::insert(const Sweep& sweep, const SweepPose& pose)
{
  map_->insert(sweep, pose);
  keyframe_ = pose.middle;
}

void Track::takeMapOf(Track&& other)
{
  map_ = std::move(other.map_);
  map_->keepWithin(settings_.horizon);
}

}  // namespace pcl_floam
