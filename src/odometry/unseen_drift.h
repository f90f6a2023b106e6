/// \file unseen_drift.h
/// What a pose may be off along directions of which the scans say nothing.
#pragma once

#include <pcl_floam/registration/registration_report.h>

#include <vector>

namespace pcl_floam {

/// Covariance of the pose along weak directions, where it is only carried on with the last known velocity. It grows
/// with the time since they were seen. What of it is in the map by then stays for good: a direction that is seen again
/// is seen in the map that drifted along.
class UnseenDrift {
public:
  /// \param velocity covariance of the motion per period, in the world's axes
  /// \param periods  since the last scan
  void carryOn(const Matrix6& velocity, double periods);

  /// Keeps what the scan said nothing of. When scans name no direction any more, the last ones count as unseen for ten
  /// scans: a single one may seem to tell of them.
  void see(const std::vector<WeakDirection>& weak);

  /// The map takes in the scan where the pose says it is: what that is off stays, if the scan named weak directions.
  /// One that seems to tell of them is where the map says.
  void enterMap();

  /// In the parametrisation of \ref RegistrationReport::covariance.
  [[nodiscard]] Matrix6 covariance() const { return in_map_ + since_; }

private:
  Matrix6 in_map_ = Matrix6::Zero();
  Matrix6 since_ = Matrix6::Zero();              ///< the last scan that took drift into the map
  Matrix6 pose_and_velocity_ = Matrix6::Zero();  ///< what their errors have in common
  Matrix6 unseen_ = Matrix6::Zero();             ///< projection onto the weak directions
  int scans_that_see_ = 0;                       ///< one after the other
};

}  // namespace pcl_floam
