#include "registration/weak_directions.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Steps along weak directions, and iterations of the others after each.
constexpr int kSteps = 5;
constexpr int kIterations = 5;

/// A direction is held if so many standard deviations of the pose along it are less than the way of the measurement.
constexpr double kCertain = 3.0;

}  // namespace

WeakDirections::WeakDirections(CloudAlignment& alignment, CloudMatching& level, double weak)
    : alignment_(alignment), level_(level), weak_(weak)
{
}

bool WeakDirections::settle(const SE3& guess, double epsilon)
{
  for (int i = 0; i < kSteps; ++i) {
    Motions weak(6, 0);
    const Vector6 step = this->step(guess, weak);
    if (weak.cols() == 0) {
      return i > 0;
    }
    alignment_.move(step);
    alignment_.hold(weak);
    alignment_.align(level_, kIterations, epsilon, false);
    alignment_.hold(Motions(6, 0));
    if (alignment_.analysis().length(step) < epsilon) {
      return true;
    }
  }
  return false;
}

/// \param[out] weak the weak directions
Vector6 WeakDirections::step(const SE3& guess, Motions& weak)
{
  const NormalEquations sums = alignment_.sums();
  const InformationAnalysis analysis = alignment_.analysis();
  Vector6 since_guess;
  since_guess << alignment_.pose().translation - guess.translation,
      logSO3(alignment_.pose().rotation * guess.rotation.transpose());
  Vector6 step = Vector6::Zero();
  for (int i = 0; i < analysis.below(weak_ * analysis.largest()); ++i) {
    const Vector6 motion = analysis.motion(i);
    const double share = this->share(analysis, i);
    const double way =
        share > 0.0 ? -motion.dot(sums.gradient) / (share * analysis.stiffness(i)) : -analysis.part(since_guess, i);
    step += (share > 0.0 ? std::clamp(way, -level_.spacing(), level_.spacing()) : way) * motion;
    weak.conservativeResize(6, weak.cols() + 1);
    weak.rightCols<1>() = motion;
  }
  return step;
}

std::vector<double> WeakDirections::shares()
{
  const InformationAnalysis analysis = alignment_.analysis();
  std::vector<double> shares;
  shares.reserve(6);
  for (int i = 0; i < analysis.below(weak_ * analysis.largest()); ++i) {
    shares.push_back(share(analysis, i));
  }
  return shares;
}

/// Of the growth of the pull that is promised, how much is there when the cloud has gone some way to either side. With
/// noise it may be below 0; 0 if it is not certain that anything holds the direction.
double WeakDirections::share(const InformationAnalysis& analysis, int direction)
{
  const Vector6 motion = analysis.motion(direction);
  const double way = level_.spacing();
  const double stiffness = analysis.stiffness(direction);
  const double behind = pull(motion, -way);
  const double share = std::min(1.0, (pull(motion, way) - behind) / (2.0 * way * stiffness));
  const double deviation = std::sqrt(alignment_.sums().residualVariance() / stiffness);
  return share > 0.0 && kCertain * deviation < share * way ? share : 0.0;
}

/// Of the matches, against a motion, when the cloud has gone some way along it.
double WeakDirections::pull(const Vector6& motion, double way)
{
  const SE3 pose = alignment_.pose();
  alignment_.move(way * motion);
  const NormalEquations sums = alignment_.evaluate(level_);
  alignment_.setPose(pose);
  return motion.dot(sums.gradient);
}

}  // namespace pcl_floam
