#include <pcl_floam/filters/scan_points.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Neighbours to each side: where returns lie so close that six steps are less than they are off, a run does not
/// matter.
constexpr std::ptrdiff_t kAside = 3;
/// A return of a straight run is off by up to so much, m: five standard deviations.
constexpr float kStraight = 0.1F;
/// Steps of one surface do not differ by more than this factor from one return to the next few.
constexpr float kUneven = 3.0F;
/// Two neighbours have no greater angle between them, rad (1.2 degrees: three steps of a coarse head): others have lost
/// what was between them, as posts before the sky have.
constexpr float kGap = 0.02F;
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
    for (std::ptrdiff_t i = low_; i < high_; ++i) {
      steps_[static_cast<std::size_t>(i)] = (at(i + 1) - at(i)).norm();
    }
    for (std::ptrdiff_t i = kAside; i > low_; --i) {
      low_ = areNext(i - 1, i) ? low_ : i;
    }
    for (std::ptrdiff_t i = kAside; i < high_; ++i) {
      high_ = areNext(i, i + 1) ? high_ : i;
    }
    if (isRun(low_, high_)) {  // as most are
      first_ = low_;
      last_ = high_;
    }
    while (low_ < first_ || high_ > last_) {
      const bool may_go_back = low_ < first_;
      const bool may_go_ahead = high_ > last_;
      may_go_back && (!may_go_ahead || step(first_ - 1) < step(last_)) ? goOn(first_ - 1, last_)
                                                                       : goOn(first_, last_ + 1);
    }
  }

  /// From one end to the other, and the step to where it may have ended.
  [[nodiscard]] Eigen::Vector3f vector() const
  {
    const auto steps = static_cast<float>(last_ - first_);
    return steps > 0.0F ? Eigen::Vector3f((1.0F + 1.0F / steps) * (at(last_) - at(first_))) : Eigen::Vector3f::Zero();
  }

private:
  Eigen::Vector3f& at(std::ptrdiff_t i) { return places_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Eigen::Vector3f& at(std::ptrdiff_t i) const { return places_[static_cast<std::size_t>(i)]; }

  [[nodiscard]] float step(std::ptrdiff_t i) const { return steps_[static_cast<std::size_t>(i)]; }

  /// Takes a neighbour in, or ends the run on its side.
  void goOn(std::ptrdiff_t first, std::ptrdiff_t last)
  {
    if (isRun(first, last)) {
      first_ = first;
      last_ = last;
    } else if (first < first_) {
      low_ = first_;
    } else {
      high_ = last_;
    }
  }

  [[nodiscard]] bool areNext(std::ptrdiff_t a, std::ptrdiff_t b) const
  {
    return at(a).cross(at(b)).norm() < kGap * at(a).dot(at(b));
  }

  [[nodiscard]] bool isRun(std::ptrdiff_t first, std::ptrdiff_t last) const
  {
    if (first == last) {
      return false;
    }
    const auto [shortest, longest] = std::minmax_element(steps_.begin() + first, steps_.begin() + last);
    return *longest <= kUneven * *shortest && isStraight(first, last);
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
      // What is not finite is not straight.
      if (!(along > before && along < length * length && chord.cross(from_first).norm() <= kStraight * length)) {
        return false;
      }
      before = along;
    }
    return true;
  }

  std::array<Eigen::Vector3f, 2 * kAside + 1> places_;
  std::array<float, 2 * kAside> steps_{};  // from each to the next
  std::ptrdiff_t low_;
  std::ptrdiff_t high_;
  std::ptrdiff_t first_ = kAside;
  std::ptrdiff_t last_ = kAside;
};

}  // namespace

void findStraightRuns(const ScanReturns& returns, std::vector<ScanPoint>& points)
{
  const ScanLines& lines = returns.lines;
  for (ScanPoint& point : points) {
    if (lines.valid() && point.laser < lines.lines()) {
      const std::ptrdiff_t begin = lines.begin[point.laser];
      const std::ptrdiff_t end = lines.begin[point.laser + 1];
      const bool is_there = begin <= point.place && point.place < end;
      if (is_there && lines.index[static_cast<std::size_t>(point.place)] == point.index) {
        Eigen::Vector3f::Map(point.run.data()) = StraightRun(returns, point.place, begin, end).vector();
      }
    }
  }
}

}  // namespace pcl_floam
