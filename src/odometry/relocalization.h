/// \file relocalization.h
/// Where the sensor is after a time in which nothing was seen.
#pragma once

#include <pcl_floam/registration/feature_registration.h>

namespace pcl_floam {

/// Scans that cannot be tracked are predicted over, and a second of that is a long time for a sensor in the hand: it
/// may have turned by anything, and what is near a wrong guess fits well enough to be followed for ever. So the scan
/// that follows is registered from guesses that are turned all around, where the sensor was last and where it is
/// predicted.
///
/// \param run      its guess is the prediction, which is kept unless another one fits clearly better
/// \param world_T_tracked pose of the last scan that was tracked
/// \return a guess within the reach of a registration, about 0.3 m
[[nodiscard]] SE3 relocalize(const FeatureSet& scan, const FeatureTarget& target, RegistrationRun run,
                             const RegistrationParameters& parameters, const SE3& world_T_tracked);

}  // namespace pcl_floam
