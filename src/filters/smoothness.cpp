#include "filters/smoothness.h"

#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

/// Norm of the mean difference to the neighbours: zero where the neighbourhood is symmetric, as on a line.
void vectorSum(const LinePoints& line, int half_window, float* sigma)
{
  const int end = line.size() - half_window;
  const float neighbors = 2.0F * static_cast<float>(half_window);
  const float* x = line.x.data();
  const float* y = line.y.data();
  const float* z = line.z.data();
  for (int n = half_window; n < end; ++n) {
    float sum_x = -neighbors * x[n];
    float sum_y = -neighbors * y[n];
    float sum_z = -neighbors * z[n];
    for (int j = 1; j <= half_window; ++j) {
      sum_x += x[n - j] + x[n + j];
      sum_y += y[n - j] + y[n + j];
      sum_z += z[n - j] + z[n + j];
    }
    sigma[n] = std::sqrt(sum_x * sum_x + sum_y * sum_y + sum_z * sum_z) / neighbors;
  }
}

}  // namespace

float meanNeighborDistance(const LinePoints& line, int n, int half_window)
{
  const auto center = static_cast<std::size_t>(n);
  float sum = 0.0F;
  for (int j = n - half_window; j <= n + half_window; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const float dx = line.x[k] - line.x[center];
    const float dy = line.y[k] - line.y[center];
    const float dz = line.z[k] - line.z[center];
    sum += std::sqrt(dx * dx + dy * dy + dz * dz);
  }
  return sum / (2.0F * static_cast<float>(half_window));
}

void computeSmoothness(const LinePoints& line, int half_window, SmoothnessKind kind, std::vector<float>& sigma)
{
  sigma.assign(line.x.size(), std::numeric_limits<float>::quiet_NaN());
  if (kind == SmoothnessKind::vector_sum) {
    vectorSum(line, half_window, sigma.data());
    return;
  }
  for (int n = half_window; n < line.size() - half_window; ++n) {
    sigma[static_cast<std::size_t>(n)] = meanNeighborDistance(line, n, half_window);
  }
}

}  // namespace pcl_floam
