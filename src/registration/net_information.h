/// \file net_information.h
/// What residuals tell of a pose, less what noise would tell as well.
#pragma once

#include "registration/normal_equations.h"

namespace pcl_floam {

/// Makes turns as long as displacements: in units of a typical point's distance from the sensor.
/// \param equations of some points that are not all at the local origin
[[nodiscard]] Vector6 commonUnits(const NormalEquations& equations);

/// An information matrix less what the noise of normals and lines and the chance of few points make of it, no less than
/// nothing along any direction: what follows from noise moves along with the sensor, and says that it stands still.
/// \param information of \p equations, or what is left of it
[[nodiscard]] Matrix6 netInformation(const NormalEquations& equations, const Matrix6& information);

}  // namespace pcl_floam
