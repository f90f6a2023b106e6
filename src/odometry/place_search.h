/// \file place_search.h
/// Where the sensor is that may be far from where it was expected.
#pragma once

#include "registration/surface_registration.h"

#include <pcl_floam/common/se3.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// How far off a pose may be.
struct Doubt {
  double far = 0.0;     ///< m
  double turned = 0.0;  ///< rad
};

/// Of a pose: perturbations in each direction with these standard deviations.
[[nodiscard]] Matrix6 covarianceOf(const Doubt& doubt);

/// Of a guess that may be so far off in all directions.
[[nodiscard]] Matrix6 guessCovarianceOf(const Doubt& doubt);

/// A place, and how far off it may still be.
struct Place {
  SE3 pose;
  Doubt doubt;
};

/// Evidence that does not tell two registrations of one motion apart.
inline constexpr double kOfOneMotion = 1.0;

/// What a registration is worth: how it explains a sweep, and how little the sensor must have been pushed about.
/// \param found      its evidence is weighed
/// \param covariance of the pose that was expected
[[nodiscard]] double likelihoodOf(const SurfaceRegistration& found, const SE3& expected, const Matrix6& covariance);

/// The registration from where a sweep is expected. If its points may be off by more than half of the map's finest
/// cells, one standard deviation, where they find other surfaces, also from so far on either side, along the motion by
/// which they may be farthest off as far as the sweep tells of it: the likeliest of the three, whose evidence is
/// weighed then.
/// \param side m, of these cells
[[nodiscard]] SurfaceRegistration registerAround(SurfaceProblem expected, double side);

/// Where a sweep fits, from a guess, looking less and less far.
/// \param expected the sweep as a track would register it; where and how fast does not count
[[nodiscard]] Place settledPlace(const SurfaceProblem& expected, const SE3& guess, Doubt doubt);

/// Where a sweep is explained best from some guesses; nothing if it is not better than from where it is expected.
/// \param side m, as \ref registerAround has it
[[nodiscard]] std::optional<SE3> betterPlace(const SurfaceProblem& expected, double side,
                                             const std::vector<SE3>& guesses, const Doubt& doubt);

/// Turned by any angle about its axis.
[[nodiscard]] std::vector<SE3> anyTurnOf(const std::vector<SE3>& poses);

}  // namespace pcl_floam
