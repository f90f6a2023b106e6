#include "filters/isolated_returns.h"

#include "common/median.h"
#include "common/multi_version.h"
#include "filters/scan_neighbors.h"

#include <algorithm>
#include <limits>

namespace pcl_floam {

namespace {

/// Neighbours on each side of a line that are looked at: a ray that has two returns puts one between.
constexpr std::size_t kToEachSide = 2;
/// Returns that lie beside each other are no farther apart than this part of their range, squared: a tenth, as lasers 2
/// degrees apart see a surface under 70 degrees of incidence, and steps along a line nearly any.
constexpr float kBesideReach = 0.1F * 0.1F;
/// Nor than so many usual steps along a line, squared, where those are longer: of a cloud that was thinned.
constexpr float kBesideSteps = 3.0F * 3.0F;

/// Twins do not bear each other out: they may be one return that is told twice.
inline std::int32_t isBeside(float squared_distance, float squared_range, float least_reach)
{
  const float reach = kBesideReach * squared_range > least_reach ? kBesideReach * squared_range : least_reach;
  return static_cast<std::int32_t>(squared_distance <= reach) & static_cast<std::int32_t>(squared_distance > 0.0F);
}

/// Coordinates along a line, which go on by \ref kToEachSide beyond both ends, with what is near nothing.
struct LineCoordinates {
  const float* x;
  const float* y;
  const float* z;

  [[nodiscard]] inline std::int32_t areBeside(std::size_t own, std::size_t other, float least_reach) const
  {
    const float dx = x[other] - x[own];
    const float dy = y[other] - y[own];
    const float dz = z[other] - z[own];
    const float squared_range = x[own] * x[own] + y[own] * y[own] + z[own] * z[own];
    return isBeside(dx * dx + dy * dy + dz * dz, squared_range, least_reach);
  }
};

/// What the next ones on both sides do not bear out.
PCL_FLOAM_MULTI_VERSION
void findLonely(std::size_t count, const LineCoordinates& line, float least_reach, std::int32_t* is_lonely)
{
  const LineCoordinates at = line;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t own = n + kToEachSide;
    is_lonely[n] = 1 - (at.areBeside(own, own - 1, least_reach) | at.areBeside(own, own + 1, least_reach));
  }
}

bool isIsolated(std::size_t n, const LineCoordinates& line, float least_reach)
{
  std::int32_t beside = 0;
  for (std::size_t other = n; other <= n + 2 * kToEachSide; ++other) {
    beside |= line.areBeside(n + kToEachSide, other, least_reach);
  }
  return beside == 0;
}

/// The usual step along a line, m^2.
float usualStep(const CloudView& cloud, const ScanLines& lines, std::vector<float>& steps)
{
  constexpr std::size_t kLooked = 31;  // one step in so many; odd, since drivers' habits are even
  steps.clear();
  for (std::size_t n = 1; n < lines.index.size(); n += kLooked) {
    const auto a = static_cast<std::size_t>(lines.index[n - 1]);
    const auto b = static_cast<std::size_t>(lines.index[n]);
    const float dx = cloud.x(a) - cloud.x(b);
    const float dy = cloud.y(a) - cloud.y(b);
    const float dz = cloud.z(a) - cloud.z(b);
    steps.push_back(dx * dx + dy * dy + dz * dz);
  }
  return medianOf(steps);
}

}  // namespace

void IsolatedReturns::leaveOut(const CloudView& cloud, ScanLines& lines)
{
  isolated_.clear();
  isolated_.reserve(lines.index.size());
  least_reach_ = kBesideSteps * usualStep(cloud, lines, steps_);
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    findOnLine(cloud, lines, m);
  }
  keepBesideOthers(cloud, lines);
  if (!isolated_.empty()) {
    takeOut(lines);
  }
}

void IsolatedReturns::findOnLine(const CloudView& cloud, const ScanLines& lines, std::size_t line)
{
  constexpr float kNowhere = std::numeric_limits<float>::infinity();
  const CloudView view = cloud;  // a copy, no longer in memory: what is written might otherwise change it
  const std::int32_t begin = lines.begin[line];
  const auto count = static_cast<std::size_t>(lines.begin[line + 1] - begin);
  const std::int32_t* index = lines.index.data() + begin;
  for (std::vector<float>& coordinates : along_) {
    coordinates.resize(count + 2 * kToEachSide);
    std::fill_n(coordinates.begin(), kToEachSide, kNowhere);
    std::fill(coordinates.end() - kToEachSide, coordinates.end(), kNowhere);
  }
  float* x = along_[0].data();
  float* y = along_[1].data();
  float* z = along_[2].data();
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(index[n]);
    x[n + kToEachSide] = view.x(i);
    y[n + kToEachSide] = view.y(i);
    z[n + kToEachSide] = view.z(i);
  }
  is_lonely_.resize(count);
  const LineCoordinates coordinates{x, y, z};
  findLonely(count, coordinates, least_reach_, is_lonely_.data());
  for (std::size_t n = 0; n < count; ++n) {
    if (is_lonely_[n] != 0 && isIsolated(n, coordinates, least_reach_)) {
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
    const Eigen::Vector3f own = across.at(kAside);
    const auto isBesideIt = [&](std::ptrdiff_t neighbor) {
      return isBeside((across.at(neighbor) - own).squaredNorm(), own.squaredNorm(), least_reach_) != 0;
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
