#include "registration/scatter_weights.h"

#include "common/median.h"

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

namespace {

double medianVariance(const std::vector<Correspondence>& planes)
{
  std::vector<double> variances;
  variances.reserve(planes.size());
  for (const auto& plane : planes) {
    if (plane.weight > 0.0) {
      variances.push_back(plane.factor.variance);
    }
  }
  return medianOf(variances);
}

}  // namespace

void weighByScatter(const std::vector<double>& weights, double scatter, std::vector<Correspondence>& planes)
{
  constexpr double kLeastVariance = 1e-6;  // m^2: no map is better than to a millimetre
  if (!(scatter > 0.0)) {
    return;
  }
  const double half = scatter * scatter * std::max(kLeastVariance, medianVariance(planes));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].weight > 0.0) {
      planes[i].weight = weights[i] * half / (half + planes[i].factor.variance);
    }
  }
}

}  // namespace pcl_floam
