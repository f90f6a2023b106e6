#include "filters/straight_runs.h"

#include "filters/scan_neighbors.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>

namespace pcl_floam {

namespace {

/// A return of a straight run is off by up to so much, m: five standard deviations.
constexpr float kStraight = 0.1F;
/// Steps of one surface do not differ by more than this factor from one return to the next few.
constexpr float kUneven = 3.0F;

/// What neighbours on a run are to each other.
struct RunLimits {
  /// Two neighbours have no greater angle between them, rad: others have lost what was between them, as posts before
  /// the sky have.
  float gap;
  /// Two returns that lie behind one another are of two things: the least sine of the angle between step and ray.
  float behind;
};
constexpr RunLimits kAlong = {kNextTo, 0.05F};
/// Scan lines are farther from each other, and so are things behind one another seen more from the side.
constexpr RunLimits kAcross = {0.1F, 0.2F};

/// Some of a return's neighbours are on a straight run with it. Lengths are compared by their squares.
class StraightRun {
public:
  StraightRun(const Neighborhood& neighbors, const RunLimits& limits)
      : neighbors_(neighbors), limits_(limits), low_(neighbors.first), high_(neighbors.last)
  {
    lookAtSteps();
    for (std::ptrdiff_t i = kAside; i > low_; --i) {
      low_ = areNext(i - 1) ? low_ : i;
    }
    for (std::ptrdiff_t i = kAside; i < high_; ++i) {
      high_ = areNext(i) ? high_ : i;
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
  static constexpr std::size_t kSteps = Neighborhood::kPlaces - 1;
  using Column = std::array<float, kSteps>;

  [[nodiscard]] Eigen::Vector3f at(std::ptrdiff_t i) const { return neighbors_.at(i); }
  [[nodiscard]] float step(std::ptrdiff_t i) const { return squared_step_[static_cast<std::size_t>(i)]; }

  /// Side by side.
  void lookAtSteps()
  {
    const auto& [x, y, z, first, last] = neighbors_;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const float dx = x[i + 1] - x[i];
      const float dy = y[i + 1] - y[i];
      const float dz = z[i + 1] - z[i];
      squared_step_[i] = dx * dx + dy * dy + dz * dz;
      const float cross_x = y[i] * z[i + 1] - z[i] * y[i + 1];
      const float cross_y = z[i] * x[i + 1] - x[i] * z[i + 1];
      const float cross_z = x[i] * y[i + 1] - y[i] * x[i + 1];
      squared_cross_[i] = cross_x * cross_x + cross_y * cross_y + cross_z * cross_z;
      dot_[i] = x[i] * x[i + 1] + y[i] * y[i + 1] + z[i] * z[i + 1];
    }
  }

  /// Whether nothing is missing between a place and the one after it.
  [[nodiscard]] bool areNext(std::ptrdiff_t i) const
  {
    const auto n = static_cast<std::size_t>(i);
    return dot_[n] > 0.0F && squared_cross_[n] < limits_.gap * limits_.gap * dot_[n] * dot_[n];
  }

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

  [[nodiscard]] bool isRun(std::ptrdiff_t first, std::ptrdiff_t last) const
  {
    if (first == last) {
      return false;
    }
    const auto [shortest, longest] = std::minmax_element(squared_step_.begin() + first, squared_step_.begin() + last);
    return *longest <= kUneven * kUneven * *shortest && isStraight(first, last);
  }

  [[nodiscard]] bool isStraight(std::ptrdiff_t first, std::ptrdiff_t last) const
  {
    const Eigen::Vector3f begin = at(first);
    const Eigen::Vector3f chord = at(last) - begin;
    const float squared_length = chord.squaredNorm();
    if (last - first == 1) {
      const Eigen::Vector3f middle = at(kAside);
      return chord.cross(middle).squaredNorm() >
             limits_.behind * limits_.behind * squared_length * middle.squaredNorm();
    }
    float before = 0.0F;
    for (std::ptrdiff_t i = first + 1; i < last; ++i) {
      const Eigen::Vector3f from_first = at(i) - begin;
      const float along = chord.dot(from_first);
      // What is not finite is not straight.
      if (!(along > before && along < squared_length &&
            chord.cross(from_first).squaredNorm() <= kStraight * kStraight * squared_length)) {
        return false;
      }
      before = along;
    }
    return true;
  }

  const Neighborhood& neighbors_;
  const RunLimits& limits_;
  Column squared_step_{};  // from each place to the next
  Column squared_cross_{};
  Column dot_{};
  std::ptrdiff_t low_;
  std::ptrdiff_t high_;
  std::ptrdiff_t first_ = kAside;
  std::ptrdiff_t last_ = kAside;
};

}  // namespace

void findStraightRuns(const ScanReturns& returns, std::vector<ScanPoint>& points)
{
  ScanNeighbors neighbors(returns.cloud, returns.lines);
  for (ScanPoint& point : points) {
    if (neighbors.knows(point)) {
      Eigen::Vector3f::Map(point.run.data()) = StraightRun(neighbors.along(point), kAlong).vector();
      Eigen::Vector3f::Map(point.run_across.data()) = StraightRun(neighbors.across(point), kAcross).vector();
    }
  }
}

}  // namespace pcl_floam
