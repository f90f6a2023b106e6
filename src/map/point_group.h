/// \file point_group.h
/// Points side by side, whose distances are computed at once.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <limits>

namespace pcl_floam {

/// Four points; those that are not there are infinitely far.
struct PointGroup {
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<float, kLanes>;

  PointGroup()
  {
    x.fill(std::numeric_limits<float>::infinity());
    y.fill(0.0F);
    z.fill(0.0F);
  }

  [[nodiscard]] Eigen::Vector3f point(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(std::size_t lane, const Eigen::Vector3f& point)
  {
    x[lane] = point.x();
    y[lane] = point.y();
    z[lane] = point.z();
  }

  [[nodiscard]] Lanes squaredDistances(const Eigen::Vector3f& place) const
  {
    Lanes squared;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float dx = x[lane] - place.x();
      const float dy = y[lane] - place.y();
      const float dz = z[lane] - place.z();
      squared[lane] = dx * dx + dy * dy + dz * dz;
    }
    return squared;
  }
  [[nodiscard]] static float leastOf(const Lanes& s) { return std::min(std::min(s[0], s[1]), std::min(s[2], s[3])); }

  Lanes x, y, z;
};

}  // namespace pcl_floam
