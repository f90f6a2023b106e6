/// \file correspondences.h
/// Features of the scan linked to lines and planes of the map.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/factors.h"

#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/registration/core/feature_registration.h>
#include <pcl_floam/registration/core/registration_parameters.h>

#include <limits>
#include <vector>

namespace pcl_floam {

/// A source point and the line or plane of the map that holds it.
///
/// The factor is kept while the point moves by less than a fiftieth of the search radius: the neighbours there tell
/// of the same surface, and searching is what takes the time.
struct Correspondence {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< now, in the target's axes, relative to the local origin
  Factor factor;                                    ///< in the same frame
  double weight = 0.0;                              ///< W of Eq. 9; 0 where no line or plane was found
  double since_reference = 0.0;                     ///< fraction of the sweep from the pose's instant to the point's
  /// Where the neighbours were searched, in the same frame.
  Eigen::Vector3d searched_at = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
};

/// The correspondences of one iteration.
struct Correspondences {
  std::vector<Correspondence> edges;
  std::vector<Correspondence> planes;
};

/// What a pose estimation works with, fixed over its iterations.
struct RegistrationProblem {
  const FeatureTarget& target;
  const RegistrationParameters& parameters;
  /// In the target frame, near the sensor. Everything is solved relative to it: the perturbation then turns about
  /// the sensor, not about a far map origin, where rotation and translation could not be told apart.
  Eigen::Vector3d origin;
  int threads = 1;
};

/// Moves the features along the trajectory, and finds the line of each edge and the plane of each plane feature.
/// \param trajectory    relative to the problem's origin
/// \param search_radius m: the farthest neighbour used must be nearer
/// \param stride        looks at every so many-th feature only
/// \param[in,out] correspondences those of the last iteration of the same problem and source, or empty
void findCorrespondences(const RegistrationProblem& problem, const FeatureSet& source,
                         const std::vector<double>& edge_weights, const std::vector<double>& plane_weights,
                         const SweepTrajectory& trajectory, double search_radius, std::size_t stride,
                         Correspondences& correspondences);

}  // namespace pcl_floam
