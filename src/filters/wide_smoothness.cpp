#include "filters/wide_smoothness.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

/// m to each side: five standard deviations of the range noise.
constexpr float kWide = 0.1F;
/// Part of a side's neighbours that the middle is averaged over on each side, one in so many.
constexpr int kMiddle = 5;
/// An edge needs a smoothness of so many times what its neighbourhood has, as by noise. With four times, a smooth
/// corridor's noise has some edges.
constexpr double kNoiseRatio = 5.0;

/// Variance of the smoothness by noise, in those of a point, over \p reach neighbours on each side.
double noiseOver(int reach, int middle)
{
  return 0.5 / reach + 1.0 / (2 * middle + 1);
}

}  // namespace

void WideSmoothness::rate(const LinePoints& line, int each_side, float spacing, const std::vector<float>& sigma,
                          const std::vector<std::int32_t>& unfit, std::vector<float>& sharpness)
{
  clear();
  const float farthest = kWide / (static_cast<float>(each_side + 1) * spacing);
  const auto isNear = [farthest](float range) { return range < farthest; };
  if (!(spacing > 0.0F) || std::none_of(line.range.begin(), line.range.end(), isNear)) {
    return;
  }
  reach_.resize(sigma.size(), 0);
  sum(line, sigma);
  for (int n = each_side; n < line.size() - each_side; ++n) {
    const auto k = static_cast<std::size_t>(n);
    if (!isNear(line.range[k]) || !(line.range[k] > 0.0F)) {
      continue;
    }
    const int wanted = static_cast<int>(std::min(kWide / (spacing * line.range[k]), static_cast<float>(line.size())));
    const int reach = std::min({wanted, n, line.size() - 1 - n});
    const float sharp = reach > each_side && unfit[k] == 0 ? sharpnessAt(n, reach, each_side) : 0.0F;
    if (sharp > sigma[k]) {
      reach_[k] = reach;
      sharpness[k] = std::max(sharpness[k], sharp);
    }
    n += reach / kMiddle;  // the next ones have nearly the same neighbourhood
  }
}

void WideSmoothness::sum(const LinePoints& line, const std::vector<float>& sigma)
{
  sums_.resize(sigma.size() + 1);
  std::array<double, 4> sum{};
  sums_[0] = sum;
  for (std::size_t n = 0; n < sigma.size(); ++n) {
    sum[0] += static_cast<double>(line.x[n]);
    sum[1] += static_cast<double>(line.y[n]);
    sum[2] += static_cast<double>(line.z[n]);
    sum[3] += std::isnan(sigma[n]) ? 0.0 : static_cast<double>(sigma[n]);
    sums_[n + 1] = sum;
  }
}

/// The part across the line: along it, it is long where returns are missing. As it would be over the line's own
/// neighbours with the same part of noise in it; 0 if it is no edge.
float WideSmoothness::sharpnessAt(int n, int reach, int each_side) const
{
  constexpr double kSmallestSquare = 1e-12;  // m^2: all at one place
  const auto sumOf = [this](int first, int last) {
    return Eigen::Array4d(Eigen::Array4d::Map(sums_[static_cast<std::size_t>(last + 1)].data()) -
                          Eigen::Array4d::Map(sums_[static_cast<std::size_t>(first)].data()));
  };
  const int middle = reach / kMiddle;
  const Eigen::Array4d before = sumOf(n - reach, n - 1) / reach;
  const Eigen::Array4d after = sumOf(n + 1, n + reach) / reach;
  const Eigen::Array4d center = sumOf(n - middle, n + middle) / (2 * middle + 1);
  const Eigen::Vector3d along = (after - before).head<3>().matrix();
  const Eigen::Vector3d mean = (0.5 * (before + after) - center).head<3>().matrix();
  const double by_along = mean.dot(along);
  const double squared_across =
      mean.squaredNorm() - by_along * by_along / std::max(along.squaredNorm(), kSmallestSquare);
  const double squared = squared_across * noiseOver(each_side, 0) / noiseOver(reach, middle);
  const double by_noise = kNoiseRatio * 0.5 * (before[3] + after[3]);
  return squared > by_noise * by_noise ? static_cast<float>(std::sqrt(squared)) : 0.0F;
}

}  // namespace pcl_floam
