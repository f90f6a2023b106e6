/// \file track_settings.h
/// What all tracks of an odometry have in common.
#pragma once

#include <pcl_floam/odometry/core/odometry_parameters.h>
#include <pcl_floam/odometry/odometry_components.h>
#include <pcl_floam/registration/core/registration_parameters.h>

#include <memory>

namespace pcl_floam {

struct TrackSettings {
  CompensationMode compensation = CompensationMode::continuous;
  DegreesOfFreedom locked = {};
  double horizon = 150.0;  // m: what lies farther from the sensor is forgotten
  int threads = 1;
  int start_effort = 10;  // registrations of one sweep's share of a start, beyond its own
  OdometryComponents components = {};
  std::weak_ptr<class SpareMaps> spare_maps = {};  // of which maps are made, and where they go in the end
  double side = 0.0;                               // m, of the map's finest cells; 0: not known yet
  /// Of time in sweeps of which it is not known: 1 as their points have it, -1 against it, 0 if they are of one
  /// instant.
  double direction = 0.0;
};

}  // namespace pcl_floam
