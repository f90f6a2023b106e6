/// \file feature_parameters.h
/// Settings of the feature extraction.
#pragma once

#include <cstdint>

namespace pcl_floam {

/// Which reading of Eq. 1.
enum class SmoothnessKind : std::uint8_t {
  vector_sum,    ///< norm of the mean of the differences (LOAM): 0 on a straight line
  mean_of_norms  ///< mean of the norms, as the paper prints it: on a wall just the points' spacing
};

[[nodiscard]] const char* toString(SmoothnessKind kind);

/// Settings of \ref FeatureExtraction.
struct FeatureParameters {
  SmoothnessKind smoothness = SmoothnessKind::vector_sum;
  int edges_per_sector = 4;    ///< most edges in one sector, a sixth of a scan line; 0 to 100
  int planes_per_sector = 20;  ///< most planes in one sector; 0 to 1000
  float min_range = 0.5F;      ///< m; nearer points are the robot itself. >= 0
  float max_range = 120.0F;    ///< m; > min_range
  /// m, >= 0; an edge needs a smoothness of more than this, above the range noise. By `vector_sum` it needs more than
  /// 0.35 times the mean distance to its neighbours as well: 0 on a line, 0.7 at a right-angled corner, 1 at the end of
  /// a surface. Near the sensor, where many neighbours are averaged, it needs as much less as they leave of the noise.
  /// Reasonable: 0.02 to 0.1
  float edge_threshold = 0.1F;
  /// m, > 0; a plane needs a smoothness of less than this. Reasonable: 0.01 to 0.1
  float plane_threshold = 0.04F;
};

/// \throws std::invalid_argument naming the first setting that is out of its range.
void validate(const FeatureParameters& parameters);

}  // namespace pcl_floam
