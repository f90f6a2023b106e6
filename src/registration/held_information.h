/// \file held_information.h
/// What residuals tell of a pose, without what they only seem to tell.
#pragma once

#include "registration/pull_growth.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/registration_parameters.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <functional>
#include <vector>

namespace pcl_floam {

struct HeldInformation {
  Matrix6 information;
  std::vector<Vector6> not_held;  ///< motions by a metre, of which it tells nothing any more
};

/// A sensor's rings lie on the rings that it has drawn into the map, and hold the pose where it was, each with a small
/// and definite error. So the pose is moved along the directions of which is known least.
/// \param information of independent residuals; motions translate (m) before they turn (rad)
/// \param way         m: by a part of what the scan's points lie apart
/// \param pull_along  of the residuals when the pose has gone some way along a motion
[[nodiscard]] HeldInformation heldInformation(const Matrix6& information, const DegreesOfFreedom& locked, double way,
                                              const std::function<Pull(const Vector6& motion, double way)>& pull_along);

/// Adds what is not held to the weak directions, at right angles to those that are there, but for what else is known.
/// \param besides information of the pose
/// \param units   of displacement, per unit of each component
void nameWhatIsNotHeld(const HeldInformation& held, const Matrix6& besides, const Vector6& units,
                       std::vector<WeakDirection>& directions);

}  // namespace pcl_floam
