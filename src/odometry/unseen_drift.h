/// \file unseen_drift.h
/// What a pose may be off along directions of which the scans say nothing.
#pragma once

#include <pcl_floam/registration/registration_report.h>

#include <vector>

namespace pcl_floam {

/// Covariance of the pose along weak directions, where it is only carried on with the last known velocity. It grows
/// with the time since they were seen, and ends when they are seen again.
class UnseenDrift {
public:
  /// \param velocity covariance of the motion per period, in the world's axes
  /// \param periods  since the last scan
  void carryOn(const Matrix6& velocity, double periods);

  /// Keeps what the scan said nothing of. A direction is seen again once that holds for a second: a single scan may
  /// seem to tell of it.
  void see(const std::vector<WeakDirection>& weak);

  /// In the parametrisation of \ref RegistrationReport::covariance.
  [[nodiscard]] const Matrix6& covariance() const { return pose_; }

private:
  Matrix6 pose_ = Matrix6::Zero();
  Matrix6 pose_and_velocity_ = Matrix6::Zero();  ///< what their errors have in common
  Matrix6 unseen_ = Matrix6::Zero();             ///< projection onto the weak directions
  int scans_that_see_ = 0;                       ///< one after the other
};

}  // namespace pcl_floam
