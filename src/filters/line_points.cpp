#include "filters/line_points.h"

#include "common/multi_version.h"

#include <cmath>

namespace pcl_floam {

namespace {

PCL_FLOAM_MULTI_VERSION
void computeRanges(std::size_t count, const float* x, const float* y, const float* z, float* range)
{
  for (std::size_t n = 0; n < count; ++n) {
    range[n] = std::sqrt(x[n] * x[n] + y[n] * y[n] + z[n] * z[n]);
  }
}

PCL_FLOAM_MULTI_VERSION
void computeSquaredSteps(std::size_t count, const float* x, const float* y, const float* z, float* squared_step)
{
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const float dx = x[n + 1] - x[n];
    const float dy = y[n + 1] - y[n];
    const float dz = z[n + 1] - z[n];
    squared_step[n] = dx * dx + dy * dy + dz * dz;
  }
}

}  // namespace

void LinePoints::gather(const CloudView& cloud, const ScanLines& lines, std::size_t m)
{
  const auto first = static_cast<std::size_t>(lines.begin[m]);
  const auto count = static_cast<std::size_t>(lines.begin[m + 1]) - first;
  x.resize(count);
  y.resize(count);
  z.resize(count);
  const std::int32_t* index = lines.index.data() + first;
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(index[n]);
    x[n] = cloud.x(i);
    y[n] = cloud.y(i);
    z[n] = cloud.z(i);
  }
  measure();
}

void LinePoints::measure()
{
  range.resize(x.size());
  squared_step.resize(x.size());
  computeRanges(x.size(), x.data(), y.data(), z.data(), range.data());
  computeSquaredSteps(x.size(), x.data(), y.data(), z.data(), squared_step.data());
  if (!squared_step.empty()) {
    squared_step.back() = 0.0F;
  }
}

}  // namespace pcl_floam
