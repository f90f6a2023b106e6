#include <pcl_floam/filters/core/feature_parameters.h>

#include "common/parameter_check.h"

#include <pcl_floam/filters/core/features.h>

#include <vector>

namespace pcl_floam {

const char* toString(SmoothnessKind kind)
{
  return kind == SmoothnessKind::vector_sum ? "vector-sum" : "mean-of-norms";
}

void validate(const FeatureParameters& p)
{
  const ParameterCheck check("feature extraction");
  check.range("edges_per_sector", p.edges_per_sector, 0, 100);
  check.range("planes_per_sector", p.planes_per_sector, 0, 1000);
  check.atLeast("min_range", p.min_range, 0.0);
  check.above("max_range", p.max_range, p.min_range);
  check.atLeast("edge_threshold", p.edge_threshold, 0.0);
  check.above("plane_threshold", p.plane_threshold, 0.0);
}

void moveFeatures(FeatureSet& features, const SE3& target_T_source)
{
  for (std::vector<Feature>* kind : {&features.edges, &features.planes}) {
    for (Feature& feature : *kind) {
      const Eigen::Vector3d place = target_T_source * Eigen::Vector3d(feature.x, feature.y, feature.z);
      feature.x = static_cast<float>(place.x());
      feature.y = static_cast<float>(place.y());
      feature.z = static_cast<float>(place.z());
    }
  }
}

}  // namespace pcl_floam
