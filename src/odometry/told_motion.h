/// \file told_motion.h
/// Whether the scans themselves tell how the sensor moves, whatever was expected.
#pragma once

#include <pcl_floam/motion/motion_hint.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <optional>

namespace pcl_floam {

/// Covariance of the position, m^2, as scan and hint tell it.
/// \param told     that of the pose as the scan alone tells it, in the parametrisation of \ref RegistrationReport
/// \param rotation from the sensor's axes, which are the hint's, to those of \p told
[[nodiscard]] Eigen::Matrix3d toldPosition(const Matrix6& told, const Eigen::Matrix3d& rotation,
                                           const std::optional<MotionHint>& hint);

/// Periods that a velocity is known for.
inline constexpr double kLongestKnown = 10.0;

/// A motion that is wrong confirms itself as long as nothing speaks against it: it is expected, and the next pose is
/// found near to where it leads. So no pose is relied on before scans have told of every direction by themselves. What
/// they have told once lasts, since a velocity does, until they leave a direction open.
class ToldMotion {
public:
  static constexpr double kNothing = 1000.0;  ///< m: nothing is told

  /// \param position of the next scan, \ref toldPosition
  /// \param periods  since the scan before: no velocity is known for ever
  void take(const Eigen::Matrix3d& position, double periods);

  /// As where a pose is given, and nothing of the velocity.
  void forget() { *this = ToldMotion(); }

  [[nodiscard]] bool isTold() const { return is_told_; }

  /// Of the last scan's position along the direction of which it tells least, one standard deviation, m.
  [[nodiscard]] double deviation() const { return deviation_; }

  /// Covariance of the motion from the scan before to the last one along what they leave open, where any speed may be
  /// as likely as any other, m^2; zero if they tell all.
  [[nodiscard]] const Eigen::Matrix3d& open() const { return open_; }

private:
  Eigen::Matrix3d open_ = Eigen::Matrix3d::Zero();
  double deviation_ = 0.0;
  double last_ = 0.0;  // information of the scan before, 1/m^2
  bool was_open_ = false;
  bool is_told_ = false;
};

}  // namespace pcl_floam
