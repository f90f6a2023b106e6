#include "filters/isolated_returns.h"

#include "common/multi_version.h"
#include "filters/scan_neighbors.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Neighbours on each side of a line that are looked at: a ray that has two returns puts one between.
constexpr std::size_t kToEachSide = 2;
/// Returns that lie beside each other differ in range by no more than this factor, squared: a tenth, as lasers 2
/// degrees apart see a surface under 70 degrees of incidence, and steps along a line nearly any.
constexpr float kSameDepth = 1.1F * 1.1F;

bool isBeside(float squared_range, float other)
{
  return std::max(squared_range, other) <= kSameDepth * std::min(squared_range, other);
}

/// \param squared_range goes on by \ref kToEachSide beyond both ends, with zeros
PCL_FLOAM_MULTI_VERSION
void findAlone(std::size_t count, const float* squared_range, std::int32_t* is_alone)
{
  for (std::size_t n = 0; n < count; ++n) {
    const float* window = squared_range + n;
    const float least = window[kToEachSide] / kSameDepth;
    const float most = window[kToEachSide] * kSameDepth;
    std::int32_t beside = -1;  // it is beside itself
    for (std::size_t i = 0; i <= 2 * kToEachSide; ++i) {
      beside += static_cast<std::int32_t>(window[i] >= least) & static_cast<std::int32_t>(window[i] <= most);
    }
    is_alone[n] = beside == 0 ? 1 : 0;
  }
}

}  // namespace

void IsolatedReturns::leaveOut(const ScanReturns& returns, ScanLines& lines)
{
  alone_.clear();
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    findAloneOnLine(returns, m);
  }
  keepBesideOthers(returns);
  if (!alone_.empty()) {
    takeOut(lines);
  }
}

void IsolatedReturns::findAloneOnLine(const ScanReturns& returns, std::size_t line)
{
  const CloudView cloud = returns.cloud;
  const std::int32_t begin = returns.lines.begin[line];
  const auto count = static_cast<std::size_t>(returns.lines.begin[line + 1] - begin);
  const std::int32_t* index = returns.lines.index.data() + begin;
  squared_range_.assign(count + 2 * kToEachSide, 0.0F);
  is_alone_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(index[n]);
    squared_range_[n + kToEachSide] = cloud.x(i) * cloud.x(i) + cloud.y(i) * cloud.y(i) + cloud.z(i) * cloud.z(i);
  }
  findAlone(count, squared_range_.data(), is_alone_.data());
  for (std::size_t n = 0; n < count; ++n) {
    if (is_alone_[n] != 0) {
      const auto i = static_cast<std::size_t>(index[n]);
      const std::int32_t place = begin + static_cast<std::int32_t>(n);
      alone_.push_back(
          {cloud.x(i), cloud.y(i), cloud.z(i), 0.5F, static_cast<std::uint32_t>(line), index[n], place, {}, {}});
    }
  }
}

/// A thin post is seen by one ray of each line, but by several lines.
void IsolatedReturns::keepBesideOthers(const ScanReturns& returns)
{
  ScanNeighbors neighbors(returns);
  const auto is_beside_another = [&neighbors](const ScanPoint& point) {
    const Neighborhood across = neighbors.across(point);
    const auto squaredRange = [&across](std::ptrdiff_t i) {
      const auto n = static_cast<std::size_t>(i);
      return across.x[n] * across.x[n] + across.y[n] * across.y[n] + across.z[n] * across.z[n];
    };
    return (across.first < kAside && isBeside(squaredRange(kAside), squaredRange(kAside - 1))) ||
           (across.last > kAside && isBeside(squaredRange(kAside), squaredRange(kAside + 1)));
  };
  alone_.erase(std::remove_if(alone_.begin(), alone_.end(), is_beside_another), alone_.end());
}

void IsolatedReturns::takeOut(ScanLines& lines) const
{
  auto next = alone_.begin();
  std::size_t kept = 0;
  std::size_t place = 0;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    const auto end = static_cast<std::size_t>(lines.begin[m + 1]);
    lines.begin[m] = static_cast<std::int32_t>(kept);
    for (; place < end; ++place) {
      if (next != alone_.end() && next->place == static_cast<std::int32_t>(place)) {
        ++next;
      } else {
        lines.index[kept++] = lines.index[place];
      }
    }
  }
  lines.begin.back() = static_cast<std::int32_t>(kept);
  lines.index.resize(kept);
}

}  // namespace pcl_floam
