/// \file feature_registration.h
/// The pose estimation from edge and plane features, for every point type: the core of \ref
/// pcl_floam::EdgePlaneRegistration.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/map/core/neighbor_search.h>
#include <pcl_floam/registration/core/pose_factor.h>
#include <pcl_floam/registration/core/registration_parameters.h>
#include <pcl_floam/registration/core/registration_report.h>
#include <pcl_floam/registration/core/sweep_model.h>

#include <functional>
#include <vector>

namespace pcl_floam {

/// Fewer features, or fewer that have something to correspond to, give no pose.
inline constexpr int kFewestCorrespondences = 20;

/// What is registered against: the searches of an edge layer and of a plane layer. Neither may be null.
struct FeatureTarget {
  const NeighborSearch* edges = nullptr;
  const NeighborSearch* planes = nullptr;
};

/// Settings of one registration that change from scan to scan.
struct RegistrationRun {
  SE3 guess;  ///< target_T_source
  /// m; how far off the guess may be: neighbours are searched this far at first, and less with each iteration
  /// down to `max_correspondence_distance`. 0 uses the latter throughout.
  double guess_uncertainty = 0.0;
  double max_correspondence_distance = 1.0;  ///< m, > 0; the farthest of the neighbours must be nearer
  int max_iterations = 30;                   ///< each with fresh correspondences; >= 1
  int threads = 1;
  double translation_epsilon = 2e-3;          ///< m; converged when a step is smaller than this ...
  double rotation_epsilon = 4e-4;             ///< ... and smaller than this, in rad
  SweepModel sweep;                           ///< default: the source is not distorted
  std::vector<PoseFactor::ConstPtr> factors;  ///< what else is known of the pose
  /// Called before each iteration with the present pose, if set.
  std::function<void(const SE3& target_T_source)> on_iteration;
};

/// Estimates the pose of a scan's features in a map by minimising the weighted point-to-line and point-to-plane
/// distances (Eq. 10), with fresh correspondences in every iteration, until it converges.
///
/// Of the source's planes 1000 are taken, evenly, and a sixth as many edges. Never throws for data; the report tells
/// what came of it. Bit-identical for every number of threads.
///
/// \param source features in the sensor's frame, distorted by the motion that `run.sweep` describes
[[nodiscard]] RegistrationReport registerFeatures(const FeatureSet& source, const FeatureTarget& target,
                                                  const RegistrationRun& run, const RegistrationParameters& parameters);

}  // namespace pcl_floam
