/// \file robust_kernel.h
/// Influence of large residuals, as weights of iteratively reweighted least squares.
#pragma once

#include "common/median.h"

#include <pcl_floam/registration/core/registration_parameters.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_floam {

/// rho'(r^2) of the kernel with the given scale: 1 for small residuals, falling for large ones.
[[nodiscard]] inline double robustWeight(RobustKernel kernel, double squared_residual, double scale)
{
  const double ratio2 = squared_residual / (scale * scale);
  switch (kernel) {
    case RobustKernel::none: return 1.0;
    case RobustKernel::huber: return ratio2 <= 1.0 ? 1.0 : 1.0 / std::sqrt(ratio2);
    case RobustKernel::cauchy: return 1.0 / (1.0 + ratio2);
    case RobustKernel::geman_mcclure: return 1.0 / ((1.0 + ratio2) * (1.0 + ratio2));
  }
  return 1.0;
}

/// rho(r^2): what the weights are the derivative of.
[[nodiscard]] inline double robustCost(RobustKernel kernel, double squared_residual, double scale)
{
  const double scale2 = scale * scale;
  const double ratio2 = squared_residual / scale2;
  switch (kernel) {
    case RobustKernel::none: return squared_residual;
    case RobustKernel::huber: return ratio2 <= 1.0 ? squared_residual : scale2 * (2.0 * std::sqrt(ratio2) - 1.0);
    case RobustKernel::cauchy: return scale2 * std::log1p(ratio2);
    case RobustKernel::geman_mcclure: return squared_residual / (1.0 + ratio2);
  }
  return squared_residual;
}

/// A kernel's scale that follows the spread of the residuals: for normally distributed ones, 1.4826 medians of the
/// absolute value are one standard deviation. Changes the squares' order.
template <typename T>
[[nodiscard]] double kernelScale(std::vector<T>& squared_residuals, double deviations, double smallest)
{
  return std::max(smallest, deviations * 1.4826 * std::sqrt(static_cast<double>(medianOf(squared_residuals))));
}

}  // namespace pcl_floam
