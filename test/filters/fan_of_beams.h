// A horizontal fan of beams, and what it meets.
#pragma once

#include "support/constants.h"

#include "filters/line_points.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace pcl_floam::test {

/// A horizontal fan of beams. The shape gives each beam's range by its azimuth, or nothing where none comes back.
using Shape = std::function<std::optional<double>(const Eigen::Vector2d& origin, const Eigen::Vector2d& ray)>;

struct Fan {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double from = -0.2;  // rad
  double to = 0.2;
  double step = 0.0035;
  double phase = 0.0;  // part of a step
};

inline LinePoints seenBy(const Fan& fan, const Shape& shape)
{
  LinePoints line;
  for (double azimuth = fan.from + fan.phase * fan.step; azimuth < fan.to; azimuth += fan.step) {
    const Eigen::Vector2d ray(std::cos(azimuth), std::sin(azimuth));
    if (const auto range = shape(fan.origin, ray)) {
      line.x.push_back(static_cast<float>(*range * ray.x()));
      line.y.push_back(static_cast<float>(*range * ray.y()));
      line.z.push_back(0.0F);
    }
  }
  line.measure();
  return line;
}

/// A wall across the view, far behind.
inline double background(const Eigen::Vector2d& origin, const Eigen::Vector2d& ray)
{
  return (40.0 - origin.x()) / ray.x();
}

/// Where a ray meets a segment; infinity if nowhere.
inline double toSegment(const Eigen::Vector2d& origin, const Eigen::Vector2d& ray, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b)
{
  Eigen::Matrix2d m;
  m << ray, a - b;
  const Eigen::Vector2d solution = m.inverse() * (a - origin);
  const bool meets = solution[0] > 0.0 && solution[1] >= 0.0 && solution[1] <= 1.0;
  return meets ? solution[0] : std::numeric_limits<double>::infinity();
}

inline Shape roundPost(const Eigen::Vector2d& center, double radius, bool with_background = true)
{
  return [=](const Eigen::Vector2d& origin, const Eigen::Vector2d& ray) -> std::optional<double> {
    const Eigen::Vector2d to_center = center - origin;
    const double along = to_center.dot(ray);
    const double inside = radius * radius - (to_center - along * ray).squaredNorm();
    if (inside >= 0.0) {
      return along - std::sqrt(inside);
    }
    return with_background ? std::optional<double>(background(origin, ray)) : std::nullopt;
  };
}

/// Straight walls from corner to corner before the background.
inline Shape walls(const std::vector<Eigen::Vector2d>& corners)
{
  return [=](const Eigen::Vector2d& origin, const Eigen::Vector2d& ray) -> std::optional<double> {
    double nearest = background(origin, ray);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      nearest = std::min(nearest, toSegment(origin, ray, corners[i], corners[i + 1]));
    }
    return nearest;
  };
}

inline std::vector<Eigen::Vector2d> squarePost(const Eigen::Vector2d& center, double side, double turn)
{
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i <= 4; ++i) {
    const double angle = turn + 0.5 * kPi * i;
    corners.emplace_back(center + side / std::sqrt(2.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

/// The places of the points that are nearer than the background by more than a metre.
inline std::vector<int> foreground(const LinePoints& line)
{
  std::vector<int> places;
  for (int n = 0; n < line.size(); ++n) {
    if (line.x[static_cast<std::size_t>(n)] < 30.0F) {
      places.push_back(n);
    }
  }
  return places;
}

inline Eigen::Vector2d inPlane(const Eigen::Vector3f& position)
{
  return position.head<2>().cast<double>();
}

inline Eigen::Vector2d pointAt(const LinePoints& line, int n)
{
  return {line.x[static_cast<std::size_t>(n)], line.y[static_cast<std::size_t>(n)]};
}

}  // namespace pcl_floam::test
