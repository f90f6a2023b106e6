#include "odometry/unseen_drift.h"

#include <Eigen/Eigenvalues>

namespace pcl_floam {

namespace {

/// Onto the span of the directions, for translations and rotations apart, as they have different units: weak directions
/// that are both belong to both.
Matrix6 projectionOnto(const std::vector<WeakDirection>& directions)
{
  constexpr double kBelongs = 0.25;  // squared length of a direction's part, of 1
  Matrix6 projection = Matrix6::Zero();
  for (const int part : {0, 3}) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const WeakDirection& weak : directions) {
      const Eigen::Vector3d direction = weak.direction.segment<3>(part);
      sum += direction * direction.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> span(sum);
    for (int i = 0; i < 3; ++i) {
      if (span.eigenvalues()[i] > kBelongs) {
        const Eigen::Vector3d axis = span.eigenvectors().col(i);
        projection.block<3, 3>(part, part) += axis * axis.transpose();
      }
    }
  }
  return projection;
}

}  // namespace

void UnseenDrift::carryOn(const Matrix6& velocity, double periods)
{
  since_ += periods * (pose_and_velocity_ + pose_and_velocity_.transpose()) + periods * periods * velocity;
  pose_and_velocity_ += periods * velocity;
}

void UnseenDrift::see(const std::vector<WeakDirection>& weak)
{
  constexpr int kSeenAgain = 10;  // scans
  scans_that_see_ = weak.empty() ? scans_that_see_ + 1 : 0;
  if (scans_that_see_ == 0 || scans_that_see_ >= kSeenAgain) {
    unseen_ = projectionOnto(weak);
  }
  since_ = unseen_ * since_ * unseen_;
  pose_and_velocity_ = unseen_ * pose_and_velocity_;
}

void UnseenDrift::enterMap()
{
  if (scans_that_see_ == 0) {
    in_map_ += since_;
    since_.setZero();
  }
}

}  // namespace pcl_floam
