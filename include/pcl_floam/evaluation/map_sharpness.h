/// \file map_sharpness.h
/// How sharp a map the poses make of their scans: accuracy where there is no ground truth.
#pragma once

#include <pcl_floam/common/se3.h>

#include <cstddef>
#include <random>
#include <vector>

namespace pcl_floam {

/// What neighbours are, and which points are taken.
struct MapSharpnessParameters {
  double radius = 0.3;         ///< m, of a neighbourhood. > 0
  std::size_t neighbors = 10;  ///< fewest points in a neighbourhood that is judged, its centre included. >= 4
  double min_range = 0.5;      ///< m, from the sensor; nearer points are the robot itself. >= 0
  double max_range = 120.0;    ///< m; farther points are left out. > min_range
  std::size_t points = 30000;  ///< of a larger scan about as many are taken, at random. > 0
};

/// The sharpness of a map. The smaller both figures, the thinner its surfaces.
struct MapSharpness {
  double mean_map_entropy = 0.0;     ///< mean of 1/2 ln det(2 pi e Sigma), Sigma in m^2; may be negative
  double mean_plane_variance = 0.0;  ///< m^2, mean of the smallest eigenvalue of Sigma
  std::size_t points = 0;            ///< neighbourhoods judged; 0: nothing was seen by two scans, both figures are 0

  /// Square root of the mean plane variance, m: how thick surfaces are, as a standard deviation.
  [[nodiscard]] double spreadAcrossPlanes() const;
};

/// Measures the map that poses make of their scans: the mean map entropy (Droeschel, Stückler, Behnke: Local
/// multi-resolution representation for 6D motion estimation and mapping with a continuously rotating 3D laser scanner,
/// ICRA 2014; Razlaw, Droeschel, Holz, Behnke: Evaluation of registration methods for sparse 3D laser scans, ECMR 2015)
/// and the mean plane variance as the smallest eigenvalue (Kornilova, Ferrer: Be your own benchmark: no-reference
/// trajectory metric on registered point clouds, ECMR 2021). Sigma is the covariance, normalised by their number, of
/// the points around a point of the map.
///
/// Neighbourhoods are judged around one point in each voxel of half the radius, so that what was seen often does not
/// count more. Only those with points of at least two scans are: within one scan all is as sharp as the sensor,
/// whatever the poses.
///
/// The figures compare poses over the same scans with the same settings. They hold the noise of the sensor and what is
/// no plane (vegetation, edges, what moves), so that no poses make them zero; and they tell of scans that saw the same
/// place, not of a drift between places.
///
/// A scan takes about 1 MB of memory, and hundreds of scans seconds to a minute of time. The same calls give the same
/// figures; they do not depend on the frame of the poses, up to rounding.
class MapSharpnessEstimation {
public:
  /// \throws std::invalid_argument if a parameter is out of range.
  explicit MapSharpnessEstimation(const MapSharpnessParameters& parameters = {});

  /// \param scan m, in the sensor's frame, all of one instant; points that are not finite are no points
  /// \param pose of the sensor at that instant, in any frame that is the same for all scans
  /// \throws std::invalid_argument if the pose is not finite, or too far from the first for a map of that radius.
  void addScan(const std::vector<Eigen::Vector3f>& scan, const SE3& pose);

  /// Of all scans so far.
  [[nodiscard]] MapSharpness compute() const;

private:
  MapSharpnessParameters parameters_;
  std::vector<Eigen::Vector3f> points_;  // in the first sensor's frame, scan by scan
  std::vector<std::size_t> ends_;        // of each scan in points_
  SE3 first_T_world_;
  std::mt19937 random_;
};

/// All in one call.
/// \throws std::invalid_argument if there are not as many poses as scans, and as MapSharpnessEstimation.
[[nodiscard]] MapSharpness mapSharpness(const std::vector<std::vector<Eigen::Vector3f>>& scans,
                                        const std::vector<SE3>& poses, const MapSharpnessParameters& parameters = {});

}  // namespace pcl_floam
