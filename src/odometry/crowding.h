/// \file crowding.h
/// Whether what fills a part of the view draws the pose away from where the rest of the scene has it.
#pragma once

#include <pcl_floam/registration/registration_report.h>

#include <Eigen/Core>

namespace pcl_floam {

/// A lorry that keeps beside the sensor fills a third of the view, has as many of the features, and says in each scan
/// that it has not moved. Of features that are spread over the scene it has its share only. They tell less
/// otherwise, so they are registered beside all features now and then, and instead of them while the two disagree again
/// and again.
class Crowding {
public:
  /// Whether the present scan should be compared; for each scan once. \return true for one in five; in three while
  /// spread features are used; for all while the last ones make it seem likely that they should be
  [[nodiscard]] bool isDue();

  /// Takes it for granted until comparisons agree again and again.
  void suspect();

  /// Registrations of the same scan, with all features and with spread ones. One that has not converged, or does not
  /// see all directions, tells nothing.
  void compare(const RegistrationReport& all, const RegistrationReport& spread);

  /// Whether the pose is that of the spread features.
  [[nodiscard]] bool misleads() const { return misleads_; }

private:
  [[nodiscard]] int scansBetween() const;

  static constexpr int kScansBetween = 5;
  int scans_since_ = kScansBetween - 1;  ///< the last comparison; the first scan is compared
  bool misleads_ = false;
  int agreements_ = 0;  ///< comparisons in a row whose mean was small
  /// Running mean of where the spread features have the pose: x, y and heading in the sensor's axes, in their standard
  /// deviations.
  Eigen::Vector3d pull_ = Eigen::Vector3d::Zero();
};

}  // namespace pcl_floam
