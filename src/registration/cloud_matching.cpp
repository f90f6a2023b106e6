#include "registration/cloud_matching.h"

#include "common/median.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace pcl_floam {

namespace {

/// Matches may be this many times the median distance apart while that is large.
constexpr double kGateMedians = 3.0;

/// A point is beside a surface up to so many spacings from it, and on it up to so many across it.
constexpr double kBesideSpacings = 10.0;
constexpr double kOnSpacings = 0.5;

}  // namespace

CloudMatching::CloudMatching(const CloudLevel& source, const CloudLevel& target, const CloudRegistrationRun& run,
                             bool finest, double along, double width)
    : source_(source),
      target_(target),
      run_(run),
      finest_(finest),
      along_(along),
      spacing_(std::max(source.spacing, target.spacing)),
      gate_(run.max_distance),
      width_(width),
      last_searches_(source.tree.size()),
      match_(source.tree.size(), -1),
      squared_distance_(source.tree.size(), 0.0F),
      residuals_(source.tree.size())
{
}

NormalEquations CloudMatching::evaluate(const SE3& pose, const SE3& target_T_source)
{
  if (run_.search && finest_) {
    askUsersSearch(pose, target_T_source);
  } else {
    searchNearest(pose);
  }
  if (run_.reciprocal) {
    keepReciprocal(pose);
  }
  narrow();
  if (run_.reject || run_.wants_matches) {
    listMatches();
  }
  if (run_.reject && !coincide()) {
    run_.reject(target_T_source, matches_);
    keepListed();
  }
  weigh(pose);
  return sum(pose);
}

void CloudMatching::searchNearest(const SE3& pose)
{
  const auto bound =
      static_cast<float>(std::min(gate_ * gate_, static_cast<double>(std::numeric_limits<float>::max())));
#pragma omp parallel for num_threads(run_.threads) schedule(dynamic, 1024)
  for (std::size_t i = 0; i < match_.size(); ++i) {
    const Eigen::Vector3f query = (pose * source_.tree.points()[i].cast<double>()).cast<float>();
    searchNearest(i, query, bound);
  }
}

void CloudMatching::searchNearest(std::size_t i, const Eigen::Vector3f& query, float bound)
{
  constexpr float kRounding = 1.001F;
  LastSearch& last = last_searches_[i];
  float limit = bound;
  float known = std::numeric_limits<float>::max();
  if (last.nearest >= 0) {
    known = squaredDistance(target_.tree.points()[static_cast<std::size_t>(last.nearest)], query);
    // The point that was nearest bounds the search: nothing farther can be nearest now.
    limit = std::min(limit, known * kRounding);
  }
  // All others are still at least so far off: if that is enough, there is nothing to search.
  const float others = last.clear / kRounding - kRounding * (query - last.place).norm();
  if (others > 0.0F && others * others > (last.found ? known : bound) * kRounding) {
    match_[i] = last.found && known <= bound ? last.nearest : -1;
    squared_distance_[i] = known;
    return;
  }
  float clear = 0.0F;
  const int found = target_.tree.nearest(query, limit, clear);
  match_[i] = found;
  squared_distance_[i] = limit;
  last.place = query;
  last.clear = std::sqrt(clear);
  last.found = found >= 0;
  last.nearest = last.found ? found : last.nearest;
}

void CloudMatching::askUsersSearch(const SE3& pose, const SE3& target_T_source)
{
  std::unordered_map<int, int> position;  // in the tree's order, of the cloud's points
  for (std::size_t j = 0; j < target_.number.size(); ++j) {
    position[target_.number[j]] = static_cast<int>(j);
  }
  for (const auto& [again, first] : target_.repeated) {
    const auto found = position.find(first);
    if (found != position.end()) {
      position[again] = int(found->second);
    }
  }
  const std::vector<int> nearest = run_.search(source_.number, target_T_source);
  for (std::size_t i = 0; i < match_.size(); ++i) {
    match_[i] = -1;
    const auto found = position.find(nearest[i]);
    if (found != position.end()) {
      const Eigen::Vector3d local = pose * source_.tree.points()[i].cast<double>();
      const Eigen::Vector3d there = target_.tree.points()[static_cast<std::size_t>(found->second)].cast<double>();
      const double squared = (there - local).squaredNorm();
      if (squared <= gate_ * gate_) {
        match_[i] = found->second;
        squared_distance_[i] = static_cast<float>(squared);
      }
    }
  }
}

void CloudMatching::keepReciprocal(const SE3& pose)
{
  const SE3 back = pose.inverse();
#pragma omp parallel for num_threads(run_.threads) schedule(dynamic, 1024)
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] >= 0) {
      const Eigen::Vector3d there = target_.tree.points()[static_cast<std::size_t>(match_[i])].cast<double>();
      float limit = std::numeric_limits<float>::max();
      if (source_.tree.nearest((back * there).cast<float>(), limit) != static_cast<int>(i)) {
        match_[i] = -1;
      }
    }
  }
}

void CloudMatching::narrow()
{
  if (!isRobust()) {
    return;
  }
  std::vector<float> squares;
  squares.reserve(match_.size());
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] >= 0) {
      squares.push_back(squared_distance_[i]);
    }
  }
  const double median = std::sqrt(static_cast<double>(medianOf(squares)));
  gate_ = std::min(gate_, std::max(kGateSpacings * spacing_, kGateMedians * median));
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (static_cast<double>(squared_distance_[i]) > gate_ * gate_) {
      match_[i] = -1;
    }
  }
}

/// Some of the points tell as much as all. A pose at which nothing is near is the worst.
double CloudMatching::agreementAt(const SE3& pose) const
{
  constexpr std::size_t kEnough = 2000;
  const double beside = std::min(run_.max_distance, kBesideSpacings * spacing_);
  const std::size_t stride = std::max<std::size_t>(1, match_.size() / kEnough);
  const std::size_t count = match_.size() / stride;
  std::ptrdiff_t near = 0;
  std::ptrdiff_t agreeing = 0;
#pragma omp parallel for num_threads(run_.threads) schedule(static) reduction(+ : agreeing, near)
  for (std::size_t i = 0; i < count * stride; i += stride) {
    auto squared = static_cast<float>(beside * beside);
    const int found = target_.tree.nearest((pose * source_.tree.points()[i].cast<double>()).cast<float>(), squared);
    if (found >= 0) {
      agreeing += vote(pose, i, static_cast<std::size_t>(found), squared);
      ++near;
    }
  }
  return near < run_.min_correspondences ? -1.0 : static_cast<double>(agreeing) / static_cast<double>(count);
}

/// 1 for the pose, -1 against it. Only surfaces tell what lies beside them.
int CloudMatching::vote(const SE3& pose, std::size_t i, std::size_t j, float squared_distance) const
{
  constexpr double kParallel = 0.9;  // cosine: 25 degrees
  const double at = kGateSpacings * spacing_;
  const double on = kOnSpacings * spacing_;
  const bool is_at = static_cast<double>(squared_distance) < at * at;
  const Residual r = residual(pose, i, j);
  bool is_on = static_cast<double>(r.squared) < on * on;
  const LocalShape& one = source_.shapes[i];
  const LocalShape& other = target_.shapes[j];
  if (one.kind == ShapeKind::plane && other.kind == ShapeKind::plane) {
    const Eigen::Vector3d normal = other.axis.cast<double>();
    is_on = std::abs(normal.dot(pose.rotation * one.axis.cast<double>())) > kParallel &&
            std::abs(normal.dot(r.difference.cast<double>())) < on;
  }
  return is_on ? static_cast<int>(is_at) : -1;
}

/// Whether all matches lie on each other but for rounding. Then there is nothing to reject, and rejectors that compare
/// distances with their spread would refuse them all.
bool CloudMatching::coincide() const
{
  float farthest = 0.0F;
  for (std::size_t i = 0; i < match_.size(); ++i) {
    farthest = match_[i] >= 0 ? std::max(farthest, squared_distance_[i]) : farthest;
  }
  return std::sqrt(static_cast<double>(farthest)) <= source_.rounding + target_.rounding;
}

void CloudMatching::listMatches()
{
  matches_.clear();
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] >= 0) {
      matches_.push_back(
          {source_.number[i], target_.number[static_cast<std::size_t>(match_[i])], squared_distance_[i]});
    }
  }
  std::sort(matches_.begin(), matches_.end(),
            [](const PointMatch& a, const PointMatch& b) { return a.source < b.source; });
}

void CloudMatching::keepListed()
{
  std::unordered_set<int> kept;
  for (const PointMatch& match : matches_) {
    kept.insert(match.source);
  }
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (kept.count(source_.number[i]) == 0) {
      match_[i] = -1;
    }
  }
}

}  // namespace pcl_floam
