/// \file net_information.h
/// What residuals tell of a pose beyond what noise would tell as well.
#pragma once

#include "registration/normal_equations.h"

#include <pcl_floam/registration/core/registration_report.h>

#include <vector>

namespace pcl_floam {

/// Makes turns as long as displacements: in units of a typical point's distance from the sensor.
/// \param equations of some points that are not all at the local origin
[[nodiscard]] Vector6 commonUnits(const NormalEquations& equations);

/// Equations in which a motion counts by the share of its information that is none of noise's. Noise moves along with
/// the sensor, and says that it stands still.
///
/// Along an axis that H and its noise N have in common, let v^T H v = lambda and v^T N v = mu lambda. With the share
/// s = 1 - mu (mu taken for more than its mean, s for none if noise may be all) the true motion d makes b = s lambda d
/// in the mean, not lambda d (errors in variables; Fuller 1987), with the variance lambda. So s b is what a motion
/// tells against what is known otherwise, s^2 lambda is how well; and while points keep their surfaces s b changes by s
/// lambda. A share of 0 leaves out an axis (solution remapping after Zhang, Kaess and Singh, 2016).
struct NetEquations {
  NormalEquations steps;  ///< s lambda and s b: what a step is made from
  NormalEquations known;  ///< s^2 lambda and s b: what is known then

  NetEquations& operator+=(const NetEquations& other);
};

[[nodiscard]] NetEquations withoutNoise(const NormalEquations& equations);

/// Motions of which residuals tell next to nothing.
struct UntoldMotions {
  Matrix6 onto = Matrix6::Zero();  ///< projects a motion on them, at right angles in common units
  /// Those of them of which nobody else tells either, at right angles in common units.
  std::vector<WeakDirection> directions;
};

/// \param net     what is left of \p all without noise
/// \param besides information from elsewhere, as so many residuals would have it
[[nodiscard]] UntoldMotions untoldMotions(const NormalEquations& net, const NormalEquations& all,
                                          const Matrix6& besides = Matrix6::Zero());

}  // namespace pcl_floam
