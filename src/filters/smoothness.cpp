#include "filters/smoothness.h"

#include "common/multi_version.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

/// Points taken at a time: their sums stay in the first cache.
constexpr std::size_t kBatch = 512;

/// Sum of one coordinate's differences to the neighbours on both sides.
inline void differenceSums(std::size_t count, std::size_t half_window, const float* x, float* sum)
{
  for (std::size_t n = 0; n < count; ++n) {
    sum[n] = -2.0F * static_cast<float>(half_window) * x[n];
  }
  for (std::size_t j = 1; j <= half_window; ++j) {
    const float* before = x - j;
    const float* after = x + j;
    for (std::size_t n = 0; n < count; ++n) {
      sum[n] += before[n] + after[n];
    }
  }
}

/// Norm of the mean difference to the neighbours: zero where the neighbourhood is symmetric, as on a line.
PCL_FLOAM_MULTI_VERSION
void vectorSum(std::size_t begin, std::size_t end, std::size_t half_window, const float* x, const float* y,
               const float* z, float* sigma)
{
  std::array<float, kBatch> sum_x;
  std::array<float, kBatch> sum_y;
  std::array<float, kBatch> sum_z;
  const float part = 0.5F / static_cast<float>(half_window);
  for (std::size_t first = begin; first < end; first += kBatch) {
    const std::size_t count = std::min(kBatch, end - first);
    differenceSums(count, half_window, x + first, sum_x.data());
    differenceSums(count, half_window, y + first, sum_y.data());
    differenceSums(count, half_window, z + first, sum_z.data());
    for (std::size_t n = 0; n < count; ++n) {
      sigma[first + n] = part * std::sqrt(sum_x[n] * sum_x[n] + sum_y[n] * sum_y[n] + sum_z[n] * sum_z[n]);
    }
  }
}

/// \return whether any point has enough neighbours; the ends have not
bool markEnds(std::size_t half_window, std::size_t count, std::vector<float>& sigma)
{
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  sigma.resize(count);
  if (count <= 2 * half_window) {
    std::fill(sigma.begin(), sigma.end(), kUnknown);
    return false;
  }
  std::fill_n(sigma.begin(), half_window, kUnknown);
  std::fill_n(sigma.rbegin(), half_window, kUnknown);
  return true;
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

float meanDifferenceAcross(const LinePoints& line, int n, int half_window)
{
  const Eigen::Vector3f center = line.at(n);
  Eigen::Vector3f before = Eigen::Vector3f::Zero();
  Eigen::Vector3f after = Eigen::Vector3f::Zero();
  for (int j = 1; j <= half_window; ++j) {
    before += line.at(n - j) - center;
    after += line.at(n + j) - center;
  }
  const Eigen::Vector3f along = (after - before).normalized();
  const Eigen::Vector3f mean = (before + after) / (2.0F * static_cast<float>(half_window));
  return (mean - mean.dot(along) * along).norm();
}

void computeSmoothness(const LinePoints& line, int half_window, SmoothnessKind kind, std::vector<float>& sigma)
{
  const auto ends = static_cast<std::size_t>(half_window);
  if (!markEnds(ends, line.x.size(), sigma)) {
    return;
  }
  if (kind == SmoothnessKind::vector_sum) {
    vectorSum(ends, sigma.size() - ends, ends, line.x.data(), line.y.data(), line.z.data(), sigma.data());
    return;
  }
  for (int n = half_window; n < line.size() - half_window; ++n) {
    sigma[static_cast<std::size_t>(n)] = meanNeighborDistance(line, n, half_window);
  }
}

void computeSmoothnessAcross(const LinePoints& line, int half_window, std::vector<float>& sigma)
{
  if (!markEnds(static_cast<std::size_t>(half_window), line.x.size(), sigma)) {
    return;
  }
  for (int n = half_window; n < line.size() - half_window; ++n) {
    sigma[static_cast<std::size_t>(n)] = meanDifferenceAcross(line, n, half_window);
  }
}

}  // namespace pcl_floam
