#include "odometry/track.h"

#include "registration/surface_registration.h"
#include "registration/sweep_points.h"

namespace pcl_floam {

namespace {

/// Points that are registered, about.
constexpr std::size_t kCells = 2000;
/// A keyframe, in sides of the finest cells and in rad.
constexpr double kKeyframeSides = 0.3;
constexpr double kKeyframeTurn = 0.1;
/// m: what lies farther from the sensor is forgotten.
constexpr double kHorizon = 150.0;

}  // namespace

RegistrationReport Track::step(const TrackedSweep& sweep)
{
  RegistrationReport report;
  if (sweep.points->empty()) {
    report.termination = Termination::too_few_features;
    report.target_T_source = motion_.pose();
    return report;
  }
  if (sweeps_ == 0) {
    begin(sweep);
    ++sweeps_;
    return report;
  }
  sampling_.sample(*sweep.points, side_, sample_);
  report = sweeps_ == 1 ? findFirstMotion(sweep) : follow(sweep);
  if (report.hasConverged()) {
    ++sweeps_;
    if (sweeps_ == 2 || isKeyframe()) {
      insert(*sweep.points, motion_.pose(), report.sweep_twist);
      map_->crop(motion_.pose().translation, kHorizon);
      keyframe_ = motion_.pose();
    }
  }
  return report;
}

void Track::begin(const TrackedSweep& sweep)
{
  side_ = sampling_.sideFor(*sweep.points, kCells);
  first_ = *sweep.points;
  first_fraction_ = sweep.sweep_fraction;
}

/// The first two sweeps share one unknown motion: the first is undistorted with today's estimate of it, and the second
/// registered with what comes out, again and again, looking less and less far.
RegistrationReport Track::findFirstMotion(const TrackedSweep& sweep)
{
  constexpr int kRounds = 6;
  constexpr double kFarthest = 2.0;       // m, of the first round
  constexpr double kFarthestTurn = 0.04;  // rad, alike
  constexpr double kLook = 3.0;           // standard deviations that the registration begins with
  RegistrationReport report;
  SE3 first_T_second;
  double far = 1.0 / kLook;
  for (int round = 0; round <= kRounds; ++round, far *= 0.5) {
    map_.emplace(side_);
    const Vector6 motion = log(first_T_second) / sweep.periods;
    insert(first_, SE3(), first_fraction_ * motion);
    if (round == kRounds) {  // the map that is kept
      motion_ = MotionEstimate(SE3(), motion);
      motion_.predict(sweep.periods);
      motion_.correct(first_T_second, report.covariance);
      break;
    }
    SurfaceProblem problem;
    problem.points = &sample_;
    problem.target = &*map_;
    problem.guess = first_T_second;
    problem.guess_covariance.topLeftCorner<3, 3>() *= far * far * kFarthest * kFarthest / 3.0;
    problem.guess_covariance.bottomRightCorner<3, 3>() *= far * far * kFarthestTurn * kFarthestTurn / 3.0;
    problem.guess_is_prior = false;
    problem.sweep_per_motion = sweep.sweep_fraction / sweep.periods;
    problem.threads = threads_;
    report = registerSurfaces(problem);
    if (!report.hasConverged()) {
      return report;
    }
    first_T_second = report.target_T_source;
  }
  return report;
}

RegistrationReport Track::follow(const TrackedSweep& sweep)
{
  SurfaceProblem problem;
  problem.earlier_pose = motion_.pose();
  motion_.predict(sweep.periods);
  problem.points = &sample_;
  problem.target = &*map_;
  problem.guess = motion_.pose();
  problem.guess_covariance = motion_.poseCovariance();
  problem.sweep_per_motion = sweep.sweep_fraction / sweep.periods;
  problem.threads = threads_;
  RegistrationReport report = registerSurfaces(problem);
  if (report.hasConverged()) {
    motion_.correct(report.target_T_source, report.covariance);
  }
  return report;
}

void Track::insert(const std::vector<ScanPoint>& points, const SE3& pose, const Vector6& sweep_twist)
{
  const MovingSensor sensor(pose, sweep_twist);
  for (const ScanPoint& point : points) {
    map_->insert(sensor.at(point), point.laser);
  }
}

bool Track::isKeyframe() const
{
  const SE3 moved = keyframe_.inverse() * motion_.pose();
  return moved.translation.norm() > kKeyframeSides * side_ || rotationAngle(moved.rotation) > kKeyframeTurn;
}

}  // namespace pcl_floam
