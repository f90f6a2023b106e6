/// \file features.h
/// Edge and plane features of one scan.
#pragma once

#include <pcl_floam/common/se3.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// A point of a scan that was found to lie on an edge or on a plane.
///
/// A plane is at its point. An edge is near it: where the surface ends or meets the next one, or at the axis of
/// something thin, with the time of the middle of what was seen of that.
struct Feature {
  float x = 0.0F;  ///< m, in the frame of the cloud
  float y = 0.0F;
  float z = 0.0F;
  float time = 0.0F;        ///< fraction of the sweep, in [0,1]
  float smoothness = 0.0F;  ///< sigma of Eq. 1, m
  std::int32_t index = -1;  ///< of the point in its cloud; of an edge, the sharpest
  float intensity = 0.0F;   ///< of that point; 0 if the cloud has none
  std::int32_t line = -1;   ///< number of its scan line; -1: of none
};

/// The feature sets E_k and S_k of one scan.
struct FeatureSet {
  std::vector<Feature> edges;
  std::vector<Feature> planes;

  void clear()
  {
    edges.clear();
    planes.clear();
  }
};

/// Gives features' places in another frame.
void moveFeatures(FeatureSet& features, const SE3& target_T_source);

}  // namespace pcl_floam
