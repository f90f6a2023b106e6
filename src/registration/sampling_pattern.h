/// \file sampling_pattern.h
/// Which motions only the sensor's own sampling pattern seems to tell.
#pragma once

#include "common/eigen_analysis.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/registration_parameters.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <functional>
#include <vector>

namespace pcl_floam {

/// What residuals say along some motions, at most three.
struct Pulls {
  Eigen::Vector3d against = Eigen::Vector3d::Zero();    ///< their gradient
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< by which it grows, as their derivatives have it
};

/// At most three, one a column; those that there are not are zero.
using TriedMotions = Eigen::Matrix<double, 6, 3, Eigen::DontAlign>;

/// Of the residuals along some motions, when the pose has moved.
using PullsWhenMoved = std::function<Pulls(const TriedMotions& motions, const Vector6& moved)>;

/// A sensor's rings lie on the rings that it has drawn into the map, and hold the pose where it was, each with a small
/// and definite error. So the pose is displaced, without a turn, along the axes of what is not known well of its
/// position, and its pulls along all of them are looked at: how much of the growth that is promised is there, when the
/// pose has gone some way to either side. What is drawn to the nearest part of a sampling pattern is drawn to the next
/// part after half of the pattern's spacing: if the way is longer than that, its pull comes back nowhere, however many
/// points have it. Where two directions are known alike, neither need be the one that only a pattern tells.
///
/// \param information of independent residuals; motions translate (m) before they turn (rad)
/// \return by a metre
[[nodiscard]] Motions motionsToldByPattern(const Matrix6& information, const DegreesOfFreedom& locked,
                                           const PullsWhenMoved& pulls);

/// Those of some motions by a metre that somebody knows better than the way by which patterns are looked for is long.
[[nodiscard]] Motions knownAmong(const Motions& motions, const Matrix6& information);

/// A projection on what residuals tell of all other motions, whatever those have been.
/// \param onto        projects on what they tell already
/// \param information of the residuals, before either projection
[[nodiscard]] Matrix6 apartFrom(const Motions& motions, const Matrix6& onto, const Matrix6& information);

/// Adds motions to the weak directions, at right angles to those that are there, but for what else is known.
/// \param besides information of the pose
/// \param units   of displacement, per unit of each component
void addToWeak(const Motions& motions, const Matrix6& besides, const Vector6& units,
               std::vector<WeakDirection>& directions);

}  // namespace pcl_floam
