#include "odometry/hypotheses.h"

#include "common/side_by_side.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// So many are followed for each direction of time.
constexpr std::ptrdiff_t kMostOfADirection = 4;

bool isLikelier(const Hypothesis& a, const Hypothesis& b)
{
  return a.evidence() > b.evidence();
}

bool hasMovedLess(const Hypothesis& a, const Hypothesis& b)
{
  return a.moved() < b.moved();
}

}  // namespace

double Hypothesis::evidence() const
{
  return is_lost ? -HUGE_VAL : track.evidence();
}

double Hypothesis::moved() const
{
  return is_lost ? HUGE_VAL : track.pose().middle.translation.norm();
}

void Hypotheses::add(Track track, const SurfaceRegistration& last, const std::vector<SweepPose>& poses)
{
  constexpr double kSame = 0.5;  // m
  Hypothesis added{std::move(track), poses, last, false, numbered_++};
  for (Hypothesis& other : all_) {
    const Eigen::Vector3d apart = other.track.pose().middle.translation - added.track.pose().middle.translation;
    if (apart.norm() < kSame && other.direction() == added.direction()) {
      if (added.track.evidence() > other.track.evidence()) {
        other = std::move(added);
      }
      return;
    }
  }
  all_.push_back(std::move(added));
}

bool Hypotheses::step(const Sweep& sweep, Rivals rivals, bool keeps_poses)
{
  eachSideBySide(front().track.settings().threads, all_.size(), [&](std::size_t i) {
    Hypothesis& hypothesis = all_[i];
    hypothesis.last = hypothesis.track.step(sweep, rivals);
    hypothesis.is_lost = !hypothesis.last.report.hasConverged();
    if (keeps_poses && !hypothesis.is_lost) {
      hypothesis.poses.push_back(hypothesis.track.pose());
    }
    if (rivals == Rivals::motions) {
      hypothesis.without_trace += hypothesis.last.report.weak_directions.empty() ? 0 : 1;
      hypothesis.track.updateMap(sweep);
    }
  });
  if (rivals == Rivals::directions) {
    updateMaps(sweep);
  }
  return std::any_of(all_.begin(), all_.end(), [](const Hypothesis& h) { return !h.is_lost; });
}

void Hypotheses::updateMaps(const Sweep& sweep)
{
  const auto goes_on = std::find_if(all_.begin(), all_.end(), [](const Hypothesis& h) { return !h.is_lost; });
  if (goes_on == all_.end()) {
    return;
  }
  const bool is_keyframe = goes_on->track.isKeyframe();
  eachSideBySide(front().track.settings().threads, all_.size(),
                 [&](std::size_t i) { all_[i].track.updateMap(sweep, is_keyframe && !all_[i].is_lost); });
}

void Hypotheses::giveUp(double behind, Rivals rivals)
{
  putFirst(Preference::likeliest);
  for (std::size_t i = all_.size(); i-- > 1;) {
    const auto here = all_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto isOfSameDirection = [&](const Hypothesis& other) { return other.direction() == here->direction(); };
    const auto best = rivals == Rivals::motions ? std::find_if(all_.begin(), here, isOfSameDirection) : all_.begin();
    if (here->is_lost || here->evidence() < best->evidence() - behind ||
        std::count_if(all_.begin(), here, isOfSameDirection) >= kMostOfADirection) {
      all_.erase(here);
    }
  }
}

void Hypotheses::putFirst(Preference preference)
{
  std::stable_sort(all_.begin(), all_.end(), preference == Preference::likeliest ? isLikelier : hasMovedLess);
}

void Hypotheses::keepOneOfEachDirection(Preference preference)
{
  putFirst(preference);
  std::vector<Hypothesis> kept;
  for (Hypothesis& hypothesis : all_) {
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Hypothesis& other) { return other.direction() == hypothesis.direction(); })) {
      kept.push_back(std::move(hypothesis));
    }
  }
  std::stable_sort(kept.begin(), kept.end(), isLikelier);
  for (Hypothesis& hypothesis : kept) {
    hypothesis.track.beginEvidence();
  }
  all_ = std::move(kept);
}

bool Hypotheses::hasRivalsInDirection() const
{
  return std::count_if(all_.begin(), all_.end(),
                       [this](const Hypothesis& other) { return other.direction() == front().direction(); }) > 1;
}

}  // namespace pcl_floam
