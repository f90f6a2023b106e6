#include <pcl_floam/filters/scan_points.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace pcl_floam {

namespace {

constexpr std::ptrdiff_t kAside = 3;  ///< neighbours to each side
/// A return of a straight run is off by up to so much, m: five standard deviations.
constexpr float kStraight = 0.1F;
/// Steps of one surface do not differ by more than this factor from one return to the next few.
constexpr float kUneven = 3.0F;
/// Two returns that lie behind one another are of two things: the least sine of the angle between step and ray.
constexpr float kBehind = 0.05F;

/// Neighbours on a scan line, of which some about the middle one are on a straight run.
class StraightRun {
public:
  /// \param place the point's own, between \p begin and \p end of its line
  StraightRun(const ScanReturns& returns, std::ptrdiff_t place, std::ptrdiff_t begin, std::ptrdiff_t end)
      : low_(kAside - std::min(kAside, place - begin)), high_(kAside + std::min(kAside, end - 1 - place))
  {
    for (std::ptrdiff_t i = low_; i <= high_; ++i) {
      const auto k = static_cast<std::size_t>(returns.lines.index[static_cast<std::size_t>(place + i - kAside)]);
      at(i) = {returns.cloud.x(k), returns.cloud.y(k), returns.cloud.z(k)};
    }
    while (low_ < first_ || high_ > last_) {
      const float back = low_ < first_ ? (at(first_ - 1) - at(first_)).norm() : kNone;
      const float ahead = high_ > last_ ? (at(last_ + 1) - at(last_)).norm() : kNone;
      high_ == last_ || (low_ < first_ && back < ahead) ? goOn(first_ - 1, last_, back)
                                                        : goOn(first_, last_ + 1, ahead);
    }
  }

  /// From one end to the other, and the step to where it may have ended.
  [[nodiscard]] Eigen::Vector3f vector() const
  {
    const auto steps = static_cast<float>(last_ - first_);
    return steps > 0.0F ? Eigen::Vector3f((1.0F + 1.0F / steps) * (at(last_) - at(first_))) : Eigen::Vector3f::Zero();
  }

private:
  static constexpr float kNone = std::numeric_limits<float>::max();

  Eigen::Vector3f& at(std::ptrdiff_t i) { return places_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Eigen::Vector3f& at(std::ptrdiff_t i) const { return places_[static_cast<std::size_t>(i)]; }

  /// Takes a neighbour in, or ends the run on its side.
  void goOn(std::ptrdiff_t first, std::ptrdiff_t last, float step)
  {
    const float longest = std::max(longest_, step);
    const float shortest = std::min(shortest_, step);
    if (longest <= kUneven * shortest && isStraight(first, last)) {
      first_ = first;
      last_ = last;
      longest_ = longest;
      shortest_ = shortest;
    } else if (first < first_) {
      low_ = first_;
    } else {
      high_ = last_;
    }
  }

  [[nodiscard]] bool isStraight(std::ptrdiff_t first, std::ptrdiff_t last) const
  {
    const Eigen::Vector3f chord = at(last) - at(first);
    const float length = chord.norm();
    if (last - first == 1) {
      return chord.cross(at(kAside)).norm() > kBehind * length * at(kAside).norm();
    }
    float before = 0.0F;
    for (std::ptrdiff_t i = first + 1; i < last; ++i) {
      const Eigen::Vector3f from_first = at(i) - at(first);
      const float along = chord.dot(from_first);
      if (along <= before || along >= length * length || chord.cross(from_first).norm() > kStraight * length) {
        return false;
      }
      before = along;
    }
    return true;
  }

  std::array<Eigen::Vector3f, 2 * kAside + 1> places_;
  std::ptrdiff_t low_;
  std::ptrdiff_t high_;
  std::ptrdiff_t first_ = kAside;
  std::ptrdiff_t last_ = kAside;
  float longest_ = 0.0F;
  float shortest_ = kNone;
};

}  // namespace

void findStraightRuns(const ScanReturns& returns, std::vector<ScanPoint>& points)
{
  const ScanLines& lines = returns.lines;
  for (ScanPoint& point : points) {
    if (lines.valid() && point.place >= 0) {
      const StraightRun run(returns, point.place, lines.begin[point.laser], lines.begin[point.laser + 1]);
      Eigen::Vector3f::Map(point.run.data()) = run.vector();
    }
  }
}

}  // namespace pcl_floam
