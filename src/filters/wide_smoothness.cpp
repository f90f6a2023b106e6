#include "filters/wide_smoothness.h"

#include "filters/selectability.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// m to each side, along a surface that is seen square on: five standard deviations of the range noise.
constexpr float kWide = 0.1F;
/// The middle is averaged over so much less than a side, on each side.
constexpr int kMiddle = 5;
/// An edge needs a smoothness of so many times what its neighbourhood has, which mostly is noise.
constexpr double kNoiseRatio = 6.0;
/// m; sums of what is farther would lose the digits of what is near.
constexpr float kFarthest = 1e4F;

/// Variance of the smoothness by noise, in those of a point: of the mean of both sides less that of the middle, which
/// is part of them.
double noiseOver(int reach, int middle)
{
  return 0.5 / reach + (1.0 - 2.0 * middle / reach) / (2 * middle + 1);
}

}  // namespace

void WideSmoothness::rate(const LinePoints& line, const WideNeighborhood& neighborhood, const std::vector<float>& sigma,
                          const std::vector<std::int32_t>& unfit, std::vector<float>& sharpness)
{
  clear();
  neighborhood_ = neighborhood;
  const int each_side = neighborhood.each_side;
  const float farthest = kWide / (static_cast<float>(each_side + 1) * neighborhood.spacing);
  const auto isRated = [&](std::size_t k) { return unfit[k] == 0 && line.range[k] > 0.0F && line.range[k] < farthest; };
  int first = 0;
  int last = line.size() - 1;
  while (first <= last && !isRated(static_cast<std::size_t>(first))) {
    ++first;
  }
  while (first <= last && !isRated(static_cast<std::size_t>(last))) {
    --last;
  }
  if (!(neighborhood.spacing > 0.0F) || first > last) {
    return;
  }
  reach_.resize(sigma.size(), 0);
  sum(line, sigma);
  Window window;
  last = std::min(last, line.size() - 1 - each_side);
  for (int n = std::max(each_side, first); n <= last; ++n) {
    const auto k = static_cast<std::size_t>(n);
    if (!isRated(k)) {
      continue;
    }
    const int reach = reachAt(line, n);
    if (reach != window.reach) {
      window = windowOf(reach);
    }
    const float sharp = reach > each_side ? sharpnessAt(n, window) : 0.0F;
    if (sharp > std::max(sigma[k], neighborhood.edge_threshold) && !isHidden(line, n, reach)) {
      reach_[k] = reach;
      sharpness[k] = std::max(sharpness[k], sharp);
    }
    n += window.middle;  // the next ones have nearly the same neighbourhood
  }
}

WideSmoothness::Window WideSmoothness::windowOf(int reach) const
{
  Window window;
  window.reach = reach;
  window.middle = reach / kMiddle;
  if (reach > 0) {
    window.per_side = 1.0 / reach;
    window.per_middle = 1.0 / (2 * window.middle + 1);
    window.noise_ratio = noiseOver(neighborhood_.each_side, 0) / noiseOver(reach, window.middle);
  }
  return window;
}

int WideSmoothness::reachAt(const LinePoints& line, int n) const
{
  const float wanted = kWide / (neighborhood_.spacing * line.range[static_cast<std::size_t>(n)]);
  return std::min({static_cast<int>(std::min(wanted, static_cast<float>(line.size()))), n, line.size() - 1 - n});
}

void WideSmoothness::sum(const LinePoints& line, const std::vector<float>& sigma)
{
  sums_.resize(sigma.size() + 1);
  std::array<double, 4> sum{};
  sums_[0] = sum;
  for (std::size_t n = 0; n < sigma.size(); ++n) {
    if (line.range[n] < kFarthest) {
      sum[0] += static_cast<double>(line.x[n]);
      sum[1] += static_cast<double>(line.y[n]);
      sum[2] += static_cast<double>(line.z[n]);
      sum[3] += sigma[n] < kFarthest ? static_cast<double>(sigma[n]) : 0.0;
    }
    sums_[n + 1] = sum;
  }
}

/// Whether a point is so near behind a depth step that the step would be its edge, which moves with the sensor.
bool WideSmoothness::isHidden(const LinePoints& line, int n, int reach) const
{
  const auto isBehind = [&](int a, int b) {  // the step to its neighbour b
    const float near = line.range[static_cast<std::size_t>(b)];
    const float step = line.range[static_cast<std::size_t>(a)] - near;
    return step > std::max(neighborhood_.edge_threshold, kDepthStep * near);
  };
  for (int i = 0; i < reach; ++i) {
    if (isBehind(n - i, n - i - 1) || isBehind(n + i, n + i + 1)) {
      return true;
    }
  }
  return false;
}

/// The part across the line: along it, it is long where returns are missing. As it would be over the line's own
/// neighbours with the same part of noise in it; 0 if it is no edge.
float WideSmoothness::sharpnessAt(int n, const Window& window) const
{
  constexpr double kSmallestSquare = 1e-12;  // m^2: all at one place
  const auto sumOf = [this](int first, int last) {
    return Eigen::Array4d(Eigen::Array4d::Map(sums_[static_cast<std::size_t>(last) + 1].data()) -
                          Eigen::Array4d::Map(sums_[static_cast<std::size_t>(first)].data()));
  };
  const Eigen::Array4d before = window.per_side * sumOf(n - window.reach, n - 1);
  const Eigen::Array4d after = window.per_side * sumOf(n + 1, n + window.reach);
  const Eigen::Array4d center = window.per_middle * sumOf(n - window.middle, n + window.middle);
  const Eigen::Vector3d mean = (0.5 * (before + after) - center).head<3>().matrix();
  const double by_noise = kNoiseRatio * 0.5 * (before[3] + after[3]);
  const double least = by_noise * by_noise / window.noise_ratio;
  if (!(mean.squaredNorm() > least)) {
    return 0.0F;
  }
  const Eigen::Vector3d along = (after - before).head<3>().matrix();
  const double by_along = mean.dot(along);
  const double squared_across =
      mean.squaredNorm() - by_along * by_along / std::max(along.squaredNorm(), kSmallestSquare);
  return squared_across > least ? static_cast<float>(std::sqrt(squared_across * window.noise_ratio)) : 0.0F;
}

void WideSmoothness::forgetAround(const LinePoints& line, int n, std::vector<float>& sharpness) const
{
  if (reach_.empty() || !(line.range[static_cast<std::size_t>(n)] > 0.0F)) {
    return;
  }
  const int reach = reachAt(line, n);
  for (int k = n - reach; k <= n + reach; ++k) {
    if (isEdge(k)) {
      sharpness[static_cast<std::size_t>(k)] = 0.0F;
    }
  }
}

}  // namespace pcl_floam
