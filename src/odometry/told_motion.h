/// \file told_motion.h
/// Whether the scans themselves tell how the sensor moves, whatever was expected.
#pragma once

#include <pcl_floam/motion/motion_hint.h>
#include <pcl_floam/registration/registration_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <optional>

namespace pcl_floam {

/// One standard deviation of the position along the direction of which scan and hint tell least, m; at most a
/// kilometre. \param told     information of the scan alone, in the parametrisation of \ref
/// RegistrationReport::information \param rotation from the sensor's axes, which are the hint's, to those of \p told
/// \param locked   nothing has to tell of these
[[nodiscard]] double leastToldDeviation(const Matrix6& told, const Eigen::Matrix3d& rotation,
                                        const std::optional<MotionHint>& hint, const DegreesOfFreedom& locked);

/// A motion that is wrong confirms itself as long as nothing speaks against it: it is expected, and the next pose is
/// found near to where it leads. So no pose is relied on before scans have told of every direction by themselves. What
/// they have told once lasts, since a velocity does, until they leave a direction open.
class ToldMotion {
public:
  /// \param deviation of a scan, \ref leastToldDeviation
  void take(double deviation);

  [[nodiscard]] bool isTold() const { return is_told_; }

private:
  double last_ = 0.0;  // information of the scan before, 1/m^2
  bool is_told_ = false;
};

}  // namespace pcl_floam
