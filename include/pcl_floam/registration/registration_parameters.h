/// \file registration_parameters.h
/// Settings of the pose estimation.
#pragma once

#include <array>
#include <cstdint>

namespace pcl_floam {

/// How the smoothness of a feature weighs its residual (Eq. 9).
enum class WeightScheme : std::uint8_t {
  uniform,   ///< all alike
  inverted,  ///< what the paper's text wants: exp(+sigma) on edges, exp(-sigma) on planes
  printed    ///< as Eq. 9 is printed: exp(-sigma) on edges, exp(+sigma) on planes
};

/// What the weights of one kind of feature add up to.
enum class WeightNormalization : std::uint8_t {
  mean_one,  ///< their number: the residuals keep their units and each feature its say
  sum_one    ///< 1, as Eq. 9: edges as a whole count as much as planes as a whole
};

/// Influence of large residuals.
enum class RobustKernel : std::uint8_t { none, huber, cauchy, geman_mcclure };

enum class SolverKind : std::uint8_t { gauss_newton, ceres };

[[nodiscard]] const char* toString(WeightScheme scheme);
[[nodiscard]] const char* toString(WeightNormalization normalization);
[[nodiscard]] const char* toString(RobustKernel kernel);
[[nodiscard]] const char* toString(SolverKind solver);

/// Degrees of freedom of a pose: translation along x, y, z, then rotation about x, y, z of the target's axes.
using DegreesOfFreedom = std::array<bool, 6>;

/// \ref RegistrationParameters::locked for a robot on level ground: height, roll and pitch.
inline constexpr DegreesOfFreedom kPlanarMotion = {false, false, true, true, true, false};

/// Settings of \ref EdgePlaneRegistration.
struct RegistrationParameters {
  SolverKind solver = SolverKind::gauss_newton;
  int max_iterations = 30;             ///< each with fresh correspondences; >= 1
  double max_neighbor_distance = 1.0;  ///< m; the farthest of the neighbours must be nearer. Reasonable: 0.5 to 3
  WeightScheme weights = WeightScheme::uniform;
  WeightNormalization weight_normalization = WeightNormalization::mean_one;
  /// What an edge counts beside a plane; > 0. Reasonable: 0.03 to 0.5. Edges are centimetres off, by the noise and the
  /// spacing of the few points that they were seen by, where planes are good to millimetres; but along corridors and
  /// roads there is little else. The paper counts each as 1 (Eq. 10). More holds in
  /// corridors, less on highways.
  double edge_weight = 0.12;
  RobustKernel kernel = RobustKernel::cauchy;  ///< its scale follows the residuals' spread
  /// Most planes that are registered, evenly taken from those of the scan, and a sixth as many edges; >= 100. The
  /// time grows with them, and errors where planes are near fall a little.
  int max_features = 1000;
  int min_correspondences = 20;  ///< fewer give no pose; >= 6
  /// Degrees of freedom that keep the guess's value; none by default. Their covariance is zero. Exact for
  /// \ref kPlanarMotion, for all translations and for all rotations; else to second order of the correction.
  DegreesOfFreedom locked = {};
};

/// \throws std::invalid_argument naming the first setting that is out of its range.
void validate(const RegistrationParameters& parameters);

}  // namespace pcl_floam
