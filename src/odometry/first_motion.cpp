#include "odometry/first_motion.h"

#include "common/side_by_side.h"
#include "filters/spatial_sampling.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>

namespace pcl_floam {

namespace {

constexpr double kNear = 0.5;  // m: as far as a registration finds a motion from a guess

/// The directions along which the position is hardly known, the worst first; none if that cannot be told. Rings that
/// seem to know the way along hide it on an open road, so what is known little better is looked along, too.
std::vector<Eigen::Vector3d> hardlyKnown(const Matrix6& information)
{
  constexpr double kLittleBetter = 10.0;  // times as much information: a third of the standard deviation
  const Eigen::Matrix<double, 6, 6> h = information;
  const Eigen::Matrix3d translation = h.topLeftCorner<3, 3>() - h.topRightCorner<3, 3>() *
                                                                    h.bottomRightCorner<3, 3>().inverse() *
                                                                    h.bottomLeftCorner<3, 3>();
  if (!translation.allFinite()) {
    return {};
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(translation);
  std::vector<Eigen::Vector3d> directions = {solver.eigenvectors().col(0)};
  if (solver.eigenvalues()[1] < kLittleBetter * solver.eigenvalues()[0]) {
    directions.emplace_back(solver.eigenvectors().col(1));
  }
  return directions;
}

/// As many points as tell which motions are likely. No edges: on an open road those of cars that keep pace would be
/// most of them, and speak for rest.
Sweep thinned(const Sweep& sweep, double side, SpatialSampling& sampling)
{
  constexpr double kMapped = 0.6;      // sides of the map's finest cells, between points that enter it
  constexpr double kRegistered = 3.0;  // between those that are registered
  Sweep thin;
  sampling.sample(sweep.dense, kMapped * side, thin.dense);
  sampling.sample(sweep.sample, kRegistered * side, thin.sample);
  thin.periods = sweep.periods;
  thin.fraction = sweep.fraction;
  thin.is_direction_known = sweep.is_direction_known;
  thin.hint = sweep.hint;
  thin.factors = sweep.factors;
  return thin;
}

/// Along the open directions both ways.
std::vector<FirstLook> looksAlong(const std::vector<Eigen::Vector3d>& open, const Sweep& second)
{
  std::vector<FirstLook> looks;
  for (const Eigen::Vector3d& direction : open) {
    for (int step = 1; step * kNear <= kFastestMotion * second.periods; ++step) {
      for (const double sign : {1.0, -1.0}) {
        Vector6 velocity = Vector6::Zero();
        velocity.head<3>() = sign * step * kNear / second.periods * direction;
        looks.push_back({velocity, kNear, 1});
      }
    }
  }
  return looks;
}

}  // namespace

FirstMotionSearch::FirstMotionSearch(const Sweep& first, const Sweep& second, const TrackSettings& settings)
    : tracks_(static_cast<std::size_t>(settings.threads), Track(settings))
{
  constexpr double kFar = 2.0;  // m
  constexpr int kFarRounds = 5;
  SpatialSampling sampling;
  first_ = thinned(first, settings.side, sampling);
  second_ = thinned(second, settings.side, sampling);
  std::vector<FirstLook> looks = {{Vector6::Zero(), kFar, kFarRounds}, {Vector6::Zero(), kNear, 1}};
  if (second.hint) {
    looks.push_back({log(second.hint->last_T_now) / second.periods, kNear, 1});
  }
  const Matrix6 information = lookAt(looks)[1].information;
  if (!found_.empty()) {
    looks_ = looksAlong(hardlyKnown(information), second_);
  }
}

std::vector<RegistrationReport> FirstMotionSearch::lookAt(const std::vector<FirstLook>& looks)
{
  std::vector<RegistrationReport> reports(looks.size());
  std::vector<double> evidence(looks.size());
  const std::size_t parts = std::min(looks.size(), tracks_.size());
  eachSideBySide(static_cast<int>(tracks_.size()), parts, [&](std::size_t part) {
    for (std::size_t i = part; i < looks.size(); i += parts) {
      reports[i] = tracks_[part].findMotion(first_, second_, looks[i]).report;
      evidence[i] = tracks_[part].evidence();
    }
    tracks_[part].releaseMap();
  });
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (reports[i].hasConverged()) {
      found_.push_back({log(reports[i].target_T_source) / second_.periods, evidence[i]});
    }
  }
  return reports;
}

void FirstMotionSearch::goOn(std::size_t looks)
{
  const auto begin = looks_.begin() + static_cast<std::ptrdiff_t>(looked_);
  lookAt({begin, begin + static_cast<std::ptrdiff_t>(looks)});
  looked_ += looks;
  if (isDone()) {
    tracks_.clear();
  }
}

double FirstMotionSearch::same() const
{
  return kNear / second_.periods;
}

/// Those whose evidence is not hopelessly less than the best, that first, no two of them the same.
std::vector<Vector6> FirstMotionSearch::likelyMotions() const
{
  constexpr double kHopeless = 0.065;  // evidence a point: among cars that keep pace the road is nearly as far behind
  std::vector<Found> best_first = found_;
  std::stable_sort(best_first.begin(), best_first.end(),
                   [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  const double least =
      best_first.empty() ? 0.0 : best_first.front().evidence - kHopeless * static_cast<double>(second_.sample.size());
  std::vector<Vector6> likely;
  for (const Found& found : best_first) {
    if (found.evidence > least && !isAmong(likely, found.velocity, same())) {
      likely.push_back(found.velocity);
    }
  }
  return likely;
}

bool isAmong(const std::vector<Vector6>& velocities, const Vector6& velocity, double same)
{
  return std::any_of(velocities.begin(), velocities.end(),
                     [&](const Vector6& other) { return (velocity - other).head<3>().norm() < same; });
}

}  // namespace pcl_floam
