#include "filters/isolated_returns.h"

#include "common/multi_version.h"
#include "filters/scan_neighbors.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Neighbours on each side of a line that are looked at: a ray that has two returns puts one between.
constexpr std::size_t kToEachSide = 2;
/// Returns that lie beside each other differ in range by no more than this factor, squared: a tenth, as lasers 2
/// degrees apart see a surface under 70 degrees of incidence, and steps along a line nearly any. How far apart they lie
/// across the ray is not asked, since clouds are thinned, and before the sky returns are far between.
constexpr float kSameDepth = 1.1F * 1.1F;

/// Twins do not bear each other out: they may be one return that is told twice.
/// \param squared_range it goes on by \ref kToEachSide beyond both ends, with zeros, which are beside nothing; so does
/// x
PCL_FLOAM_MULTI_VERSION
void findIsolated(std::size_t count, const float* squared_range, const float* x, std::int32_t* is_isolated)
{
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t own = n + kToEachSide;
    const float least = squared_range[own] / kSameDepth;
    const float most = squared_range[own] * kSameDepth;
    std::int32_t beside = 0;
    for (std::size_t i = n; i <= n + 2 * kToEachSide; ++i) {
      beside |= static_cast<std::int32_t>(squared_range[i] >= least) &
                static_cast<std::int32_t>(squared_range[i] <= most) & static_cast<std::int32_t>(x[i] != x[own]);
    }
    is_isolated[n] = 1 - beside;
  }
}

}  // namespace

std::size_t IsolatedReturns::leaveOut(const CloudView& cloud, ScanLines& lines)
{
  isolated_.clear();
  isolated_.reserve(lines.index.size());
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    findOnLine(cloud, lines, m);
  }
  keepBesideOthers(cloud, lines);
  if (!isolated_.empty()) {
    takeOut(lines);
  }
  return isolated_.size();
}

void IsolatedReturns::findOnLine(const CloudView& cloud, const ScanLines& lines, std::size_t line)
{
  const CloudView view = cloud;  // a copy, no longer in memory: what is written might otherwise change it
  const std::int32_t begin = lines.begin[line];
  const auto count = static_cast<std::size_t>(lines.begin[line + 1] - begin);
  const std::int32_t* index = lines.index.data() + begin;
  squared_range_.assign(count + 2 * kToEachSide, 0.0F);
  x_.assign(count + 2 * kToEachSide, 0.0F);
  float* squared_range = squared_range_.data() + kToEachSide;
  float* x = x_.data() + kToEachSide;
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(index[n]);
    x[n] = view.x(i);
    squared_range[n] = view.x(i) * view.x(i) + view.y(i) * view.y(i) + view.z(i) * view.z(i);
  }
  is_isolated_.resize(count);
  findIsolated(count, squared_range_.data(), x_.data(), is_isolated_.data());
  for (std::size_t n = 0; n < count; ++n) {
    if (is_isolated_[n] != 0) {
      isolated_.push_back({begin + static_cast<std::int32_t>(n), static_cast<std::uint32_t>(line)});
    }
  }
}

/// A thin post is seen by one ray of each line, but by several lines.
void IsolatedReturns::keepBesideOthers(const CloudView& cloud, const ScanLines& lines)
{
  const auto is_beside_another = [&](const Isolated& isolated) {
    const std::int32_t index = lines.index[static_cast<std::size_t>(isolated.place)];
    const auto i = static_cast<std::size_t>(index);
    // Anew for each: they lie too far from each other for one to lead to the next.
    const Neighborhood across =
        ScanNeighbors(cloud, lines)
            .across({cloud.x(i), cloud.y(i), cloud.z(i), 0.5F, isolated.line, index, isolated.place, {}, {}});
    const float own = across.at(kAside).squaredNorm();
    const auto isBesideIt = [&](std::ptrdiff_t neighbor) {
      const float other = across.at(neighbor).squaredNorm();
      return other <= kSameDepth * own && own <= kSameDepth * other;
    };
    return (across.first < kAside && isBesideIt(kAside - 1)) || (across.last > kAside && isBesideIt(kAside + 1));
  };
  isolated_.erase(std::remove_if(isolated_.begin(), isolated_.end(), is_beside_another), isolated_.end());
}

void IsolatedReturns::takeOut(ScanLines& lines) const
{
  auto next = isolated_.begin();
  std::size_t kept = 0;
  std::size_t place = 0;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    const auto end = static_cast<std::size_t>(lines.begin[m + 1]);
    lines.begin[m] = static_cast<std::int32_t>(kept);
    for (; place < end; ++place) {
      if (next != isolated_.end() && next->place == static_cast<std::int32_t>(place)) {
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
