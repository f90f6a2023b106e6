/// \file normal_equations.h
/// H and b of all weighted residuals, in one pass (Eq. 10 to 14).
#pragma once

#include "registration/correspondences.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/sweep_model.h>

#include <cstddef>
#include <functional>

namespace pcl_floam {

/// Scale of the robust kernel for each kind of residual, m.
struct KernelScales {
  double edge = 0.0;
  double plane = 0.0;
};

/// Below it no residual is an outlier: maps are no better, m.
inline constexpr double kSmallestKernelScale = 0.05;

/// The kernel's scale follows the spread of the residuals, measured by their median.
[[nodiscard]] KernelScales adaptKernelScales(const Correspondences& correspondences);

/// Sums over all correspondences.
///
/// A point measured s after the pose's instant moves with a perturbation delta of the pose and epsilon of the twist
/// over the sweep as delta + s epsilon: J is the derivative by the former, s J by the latter.
struct NormalEquations {
  Matrix6 information = Matrix6::Zero();  ///< H = sum w J^T J
  /// The part of H that noise makes: that of the planes' normals, sum w J^T J with J of the normals' tilts, and by
  /// surfaces of the lines' directions, too, and a share of what nearest points tell. Along a smooth corridor there is
  /// nothing else in H.
  Matrix6 noise_information = Matrix6::Zero();
  Matrix6 coupling = Matrix6::Zero();           ///< sum w s J^T J: of pose and twist
  Matrix6 twist_information = Matrix6::Zero();  ///< sum w s^2 J^T J
  Vector6 gradient = Vector6::Zero();           ///< b = sum w J^T r
  Vector6 twist_gradient = Vector6::Zero();     ///< sum w s J^T r
  double cost = 0.0;                            ///< half the sum of W rho(r^2), m^2
  double weighted_squares = 0.0;                ///< sum w r^2, m^2
  double weight = 0.0;                          ///< sum w
  double given_weight = 0.0;                    ///< sum W, without the robust kernel's say
  double squared_extent = 0.0;                  ///< sum w |q|^2: spread of the points about the local origin, m^2
  int edges = 0;                                ///< points held by a line, ...
  int planes = 0;                               ///< ... by a plane, ...
  int points = 0;                               ///< ... and by a point that is part of neither
  int edge_inliers = 0;
  int plane_inliers = 0;

  NormalEquations& operator+=(const NormalEquations& other);
  [[nodiscard]] int count() const { return edges + planes + points; }

  /// Weighted mean of the squared residuals, m^2.
  [[nodiscard]] double residualVariance() const { return weight > 0.0 ? weighted_squares / weight : 0.0; }
};

/// Adds up what each of some chunks of elements comes to, in order: the same bits for every number of threads.
/// \param count  of all elements
/// \param sumsOf of the elements from the first to the one before the last
[[nodiscard]] NormalEquations sumOfChunks(
    std::size_t count, std::size_t per_chunk, int threads,
    const std::function<NormalEquations(std::size_t first, std::size_t last)>& sumsOf);

/// \return the sums, bit-identical for every number of threads: fixed chunks, added in order
[[nodiscard]] NormalEquations buildNormalEquations(const RegistrationProblem& problem,
                                                   const Correspondences& correspondences, const KernelScales& scales);

/// The equations as the model's pose sees them: where the twist follows from the pose, a change of the pose moves
/// points measured before its instant less, and points after it more.
[[nodiscard]] NormalEquations reducedToPose(const NormalEquations& equations, const SweepModel& model);

}  // namespace pcl_floam
