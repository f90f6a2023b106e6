/// \file scan_neighbors.h
/// The neighbours of a scan's returns, on their scan line and on the next ones.
#pragma once

#include <pcl_floam/filters/core/scan_point.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace pcl_floam {

/// Neighbours to each side: where returns lie so close that six steps are less than they are off, a run does not
/// matter.
constexpr std::ptrdiff_t kAside = 3;
/// Neighbours on a scan line have no greater angle between them, rad: 1.2 degrees, three steps of a coarse head.
constexpr float kNextTo = 0.02F;

/// Neighbours of a return, in the order in which they lie, and itself in the middle.
struct Neighborhood {
  static constexpr std::ptrdiff_t kPlaces = 2 * kAside + 1;

  std::array<float, kPlaces> x, y, z;  // beyond its ends anything finite stands, which is not used
  std::ptrdiff_t first = kAside;
  std::ptrdiff_t last = kAside;

  void put(std::ptrdiff_t i, const CloudView& cloud, std::int32_t index)
  {
    const auto n = static_cast<std::size_t>(i);
    const auto k = static_cast<std::size_t>(index);
    x[n] = cloud.x(k);
    y[n] = cloud.y(k);
    z[n] = cloud.z(k);
  }

  [[nodiscard]] Eigen::Vector3f at(std::ptrdiff_t i) const
  {
    const auto n = static_cast<std::size_t>(i);
    return {x[n], y[n], z[n]};
  }
};

/// Of a scan, the neighbours of its returns.
class ScanNeighbors {
public:
  ScanNeighbors(const CloudView& cloud, const ScanLines& lines) : cloud_(cloud), lines_(lines) {}

  /// Whether the scan lines have a point where it says.
  [[nodiscard]] bool knows(const ScanPoint& point) const
  {
    if (!lines_.valid() || point.laser >= lines_.lines()) {
      return false;
    }
    const bool is_there = lines_.begin[point.laser] <= point.place && point.place < lines_.begin[point.laser + 1];
    return is_there && indexAt(point.place) == point.index;
  }

  [[nodiscard]] Neighborhood along(const ScanPoint& point) const
  {
    Neighborhood neighbors;
    neighbors.first = kAside - std::min<std::ptrdiff_t>(kAside, point.place - lines_.begin[point.laser]);
    neighbors.last = kAside + std::min<std::ptrdiff_t>(kAside, lines_.begin[point.laser + 1] - 1 - point.place);
    for (std::ptrdiff_t i = 0; i < Neighborhood::kPlaces; ++i) {
      neighbors.put(i, cloud_, indexAt(point.place + std::clamp(i, neighbors.first, neighbors.last) - kAside));
    }
    return neighbors;
  }

  /// On the next scan lines, in nearly the same direction. Fastest for points that follow each other.
  [[nodiscard]] Neighborhood across(const ScanPoint& point)
  {
    Neighborhood neighbors;
    for (std::ptrdiff_t i = 0; i < Neighborhood::kPlaces; ++i) {
      neighbors.put(i, cloud_, point.index);
    }
    const std::ptrdiff_t below = towards(point, nextLine(point.laser, -1), below_);
    const std::ptrdiff_t above = towards(point, nextLine(point.laser, 1), above_);
    if (below != kNone) {
      neighbors.put(--neighbors.first, cloud_, indexAt(below));
    }
    if (above != kNone) {
      neighbors.put(++neighbors.last, cloud_, indexAt(above));
    }
    return neighbors;
  }

private:
  [[nodiscard]] std::int32_t indexAt(std::ptrdiff_t place) const
  {
    return lines_.index[static_cast<std::size_t>(place)];
  }

  /// The next line up or down that has returns; none beyond the last.
  [[nodiscard]] std::ptrdiff_t nextLine(std::uint32_t line, std::ptrdiff_t step) const
  {
    const auto lines = static_cast<std::ptrdiff_t>(lines_.lines());
    std::ptrdiff_t next = static_cast<std::ptrdiff_t>(line) + step;
    while (0 <= next && next < lines && countOf(next) == 0) {
      next += step;
    }
    return next < lines ? next : kNone;
  }

  [[nodiscard]] std::ptrdiff_t countOf(std::ptrdiff_t line) const
  {
    const auto m = static_cast<std::size_t>(line);
    return lines_.begin[m + 1] - lines_.begin[m];
  }

  /// Unit, but for what is at the sensor.
  [[nodiscard]] Eigen::Vector3f rayAt(std::ptrdiff_t place) const
  {
    const auto k = static_cast<std::size_t>(indexAt(place));
    const Eigen::Vector3f point(cloud_.x(k), cloud_.y(k), cloud_.z(k));
    return point / std::sqrt(std::max(point.squaredNorm(), kNoRange));
  }

  /// Whether a ray goes by beside the return at a place, as where those between are missing.
  /// \param begin of its line, and the last place
  [[nodiscard]] bool isAside(const Eigen::Vector3f& ray, std::ptrdiff_t place, std::ptrdiff_t begin,
                             std::ptrdiff_t last) const
  {
    const Eigen::Vector3f along = rayAt(std::min(place + 1, last)) - rayAt(std::max(place - 1, begin));
    return !(std::abs(along.dot(ray.normalized() - rayAt(place))) <= kNextTo * along.norm());
  }

  /// What was found last: how much farther on another line the same direction is than on a point's own.
  struct Lead {
    std::uint32_t of = 0xFFFFFFFFU;  // a line
    std::ptrdiff_t ahead = 0;
  };

  /// The place on another line in a direction, to a part of the line.
  [[nodiscard]] std::ptrdiff_t roughly(const Eigen::Vector3f& ray, std::ptrdiff_t begin, std::ptrdiff_t last) const
  {
    constexpr std::ptrdiff_t kParts = 32;
    const std::ptrdiff_t stride = (last - begin) / kParts + 1;
    std::ptrdiff_t best = begin;
    float nearest = -std::numeric_limits<float>::infinity();
    for (std::ptrdiff_t place = begin; place <= last; place += stride) {
      const float near = ray.dot(rayAt(place));
      best = near > nearest ? place : best;
      nearest = std::max(near, nearest);
    }
    return best;
  }

  /// The place on another line: from where the last one leads, to where it is no nearer; none if that is aside.
  [[nodiscard]] std::ptrdiff_t towards(const ScanPoint& point, std::ptrdiff_t line, Lead& lead) const
  {
    if (line == kNone) {
      return kNone;
    }
    const std::ptrdiff_t begin = lines_.begin[static_cast<std::size_t>(line)];
    const std::ptrdiff_t last = begin + countOf(line) - 1;
    const Eigen::Vector3f ray(point.x, point.y, point.z);
    if (lead.of != point.laser) {
      lead.of = point.laser;
      lead.ahead = roughly(ray, begin, last) - point.place;
    }
    std::ptrdiff_t place = std::clamp(point.place + lead.ahead, begin, last);
    float nearest = ray.dot(rayAt(place));
    for (const std::ptrdiff_t step : {1, -1}) {
      for (int steps = 0; steps < kMostSteps && begin <= place + step && place + step <= last; ++steps) {
        const float next = ray.dot(rayAt(place + step));
        if (!(next >= nearest)) {
          break;
        }
        nearest = next;
        place += step;
      }
    }
    lead.ahead = place - point.place;
    return isAside(ray, place, begin, last) ? kNone : place;
  }

  static constexpr std::ptrdiff_t kNone = -1;
  static constexpr float kNoRange = 1e-12F;  ///< m^2
  /// As many returns as a line may have lost: a tenth of a turn of most lidars.
  static constexpr int kMostSteps = 200;

  const CloudView& cloud_;
  const ScanLines& lines_;
  Lead below_;
  Lead above_;
};

}  // namespace pcl_floam
