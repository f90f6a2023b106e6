#include "odometry/first_scans.h"

#include "common/covariance.h"
#include "common/perturbation.h"
#include "odometry/start.h"

#include <algorithm>

namespace pcl_floam {

void FirstScans::begin(const FeatureSet& features)
{
  *this = FirstScans();
  open_ = true;
  at_.push_back({});
  features_ = {features};
}

void FirstScans::add(const FeatureSet& features)
{
  at_.push_back({++sweep_, 0.0});
  features_.push_back(features);
  if (features_.size() > kMostKept) {
    features_.erase(features_.begin());
  }
}

void FirstScans::miss()
{
  if (open_) {
    at_.push_back({sweep_, periods_});
  }
}

void FirstScans::repeat()
{
  if (open_ && !given_.empty()) {
    at_.push_back(Place(at_.back()));
    given_.push_back(SE3(given_.back()));
  }
}

void FirstScans::give(const SE3& world_T_sensor)
{
  if (open_) {
    given_.push_back(world_T_sensor);
  }
}

std::vector<SE3> FirstScans::correct(const std::vector<SweepPose>& poses, const SE3& world_T_track, double instant)
{
  constexpr double kSame = 1e-3;  // m
  constexpr double kJump = 0.1;   // m
  std::vector<SE3> corrected;
  double most = 0.0;
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const SweepPose& before = poses[at_[i].sweep];
    const SweepPose& after = poses[std::min(at_[i].sweep + 1, poses.size() - 1)];
    SE3 pose = before.at(instant);
    if (at_[i].periods_after > 0.0) {
      // The next sweep that was registered is so many periods after the last one.
      double until_next = at_[i].periods_after + 1.0;
      for (std::size_t k = i; k < at_.size() && at_[k].sweep == at_[i].sweep; ++k) {
        until_next = at_[k].periods_after + 1.0;
      }
      pose = pose * exp(at_[i].periods_after / until_next * log(before.at(instant).inverse() * after.at(instant)));
    }
    corrected.push_back(world_T_track * pose);
    most = std::max(most, (corrected.back().translation - given_[i].translation).norm());
  }
  jumped_ = most > kJump;
  if (most < kSame) {
    return {};
  }
  given_ = corrected;
  return corrected;
}

Matrix6 turned(const Matrix6& covariance, const SE3& world_T_track)
{
  return propagated(turnOf(world_T_track.rotation), covariance);
}

void turnIntoWorld(OdometryReport& report, const SE3& world_T_track)
{
  RegistrationReport& r = report.registration;
  r.target_T_source = world_T_track * r.target_T_source;
  r.information = turned(r.information, world_T_track);
  r.covariance = turned(r.covariance, world_T_track);
  for (WeakDirection& weak : r.weak_directions) {
    weak.direction.head<3>() = world_T_track.rotation * Eigen::Vector3d(weak.direction.head<3>());
    weak.direction.tail<3>() = world_T_track.rotation * Eigen::Vector3d(weak.direction.tail<3>());
  }
}

}  // namespace pcl_floam
