/// \file correspondences.h
/// Features of the scan linked to lines and planes of the map, and what each counts.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/factors.h"

#include <pcl_floam/filters/core/feature_kind.h>
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

/// What an edge counts beside a plane, where Eq. 10 is not taken as printed, with 1. Edges are centimetres off, by the
/// noise and the spacing of the few points that they were seen by, where planes are good to millimetres; but along
/// corridors and roads there is little else.
inline constexpr double kEdgeWeight = 0.12;

/// W(p) of every feature of one kind (Eq. 9). But as printed they sum up to the features' number, or to \ref
/// kEdgeWeight times that of the edges: residuals keep their units, and each feature its say.
[[nodiscard]] std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind,
                                                    WeightScheme scheme);

/// A plane counts half if its map points' standard deviation across it is so many times the median of the scan's
/// planes.
inline constexpr double kPlaneScatter = 2.0;

/// Weighs each linked plane by W / (1 + v / (kPlaneScatter^2 m)), where v is its variance and m the median of all.
///
/// Five neighbours at the foot of a wall or a shelf are no plane, but tilt and lift the one that is fitted to them, and
/// always to the same side: the floor has things standing on it, none hang below.
/// \param weights W of Eq. 9, for each of the planes
void weighByScatter(const std::vector<double>& weights, std::vector<Correspondence>& planes);

}  // namespace pcl_floam
