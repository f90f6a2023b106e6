#include <pcl_floam/filters/core/features.h>

namespace pcl_floam {

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
