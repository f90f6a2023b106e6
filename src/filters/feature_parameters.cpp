#include <pcl_floam/filters/core/feature_parameters.h>

#include "common/parameter_check.h"

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

}  // namespace pcl_floam
