/// \file registration_pairs.h
/// Pairs of clouds with known transforms: scans, rooms, objects, key points, halves.
#pragma once

#include <pcl_floam/common/se3.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>
#include <vector>

namespace pcl_floam::benchmark {

using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;

/// Two clouds and what is true about them.
struct CloudPair {
  Cloud::Ptr source;
  Cloud::Ptr target;
  SE3 target_T_source;
  double extent = 1.0;          ///< root mean square distance of the source's points from their centroid, m
  double ndt_resolution = 1.0;  ///< m; what one would choose for such clouds
  double success = 0.0;         ///< m; an error up to this counts as success
};

/// Pairs of one kind.
struct PairKind {
  std::string name;
  std::vector<CloudPair> pairs;       ///< as large as such clouds are: for errors and times
  std::vector<CloudPair> grid_pairs;  ///< smaller where the kind allows: for the grid of initial offsets
};

/// A scene of shapes, sampled: what is on a table, or a room.
struct SceneSampling {
  unsigned scene = 1;  ///< number of the scene
  unsigned seed = 1;   ///< of the sampling
  int points = 20000;
  double noise = 0.0;  ///< m, standard deviation
  double scale = 1.0;
};

/// A table with a box, a ball, a cylinder and a bent sheet on it; about 1.5 m across for scale 1.
[[nodiscard]] Cloud::Ptr sampleTable(const SceneSampling& sampling);

/// One closed curved object without any flat part.
[[nodiscard]] Cloud::Ptr sampleObject(const SceneSampling& sampling);

/// Root mean square distance of a cloud's points from their centroid, m.
[[nodiscard]] double extentOf(const Cloud& cloud);

/// Root mean square distance of where two transforms put a cloud's points.
[[nodiscard]] double disagreement(const Cloud& cloud, const SE3& a, const SE3& b);

/// Which pairs to make.
struct PairSelection {
  std::vector<std::string> kinds;  ///< by name; empty: all
  std::string data;                ///< folder of real data (KITTI raw 0001); these are left out if it is not there
  unsigned seed = 0;               ///< other scenes and worlds for other seeds; the README's are those of 0
  bool quick = false;              ///< one pair of each kind, no grid, nothing large
};

/// All kinds wanted that can be made on this machine.
[[nodiscard]] std::vector<PairKind> makePairs(const PairSelection& selection);

}  // namespace pcl_floam::benchmark
