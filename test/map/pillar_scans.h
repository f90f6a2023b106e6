// Scans of a pillar, or a pole, before a wall all around.
#pragma once

#include "support/constants.h"

#include <pcl_floam/map/keyframe_voxel_map.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_floam::test {

using Points = std::vector<Eigen::Vector3f>;

inline constexpr float kHeight = 0.4F;  // of the sensor above the floor
inline constexpr float kHalfTurn = static_cast<float>(kPi);

/// Where a beam from the origin meets the floor, a wall around the sensor, or a pillar ahead of it.
inline Eigen::Vector3f meet(float azimuth, float elevation, float wall, bool pillar)
{
  const Eigen::Vector3f beam(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
  float range = wall / std::cos(elevation);
  if (elevation < 0.0F) {
    range = std::min(range, kHeight / -std::sin(elevation));
  }
  if (pillar && std::abs(azimuth) < 0.1F) {
    range = std::min(range, 5.0F / std::cos(elevation));
  }
  return range * beam;
}

/// A scan of \p lines over 33 degrees, its points \p step apart in azimuth.
inline Points scanOf(float wall, bool pillar, float step = 0.006F, int lines = 64)
{
  Points points;
  for (int line = 0; line < lines; ++line) {
    for (float azimuth = -kHalfTurn; azimuth < kHalfTurn; azimuth += step) {
      const float share = static_cast<float>(line) / static_cast<float>(lines);
      points.push_back(meet(azimuth, -0.45F + 0.576F * share, wall, pillar));
    }
  }
  return points;
}

inline FeatureSet featuresAt(const Points& points)
{
  FeatureSet features;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Feature feature;
    feature.x = points[i].x();
    feature.y = points[i].y();
    feature.z = points[i].z();
    (i % 5 == 0 ? features.edges : features.planes).push_back(feature);
  }
  return features;
}

inline std::size_t pillarPoints(const KeyframeVoxelMap& map, const SE3& pose)
{
  std::size_t count = 0;
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    for (const Eigen::Vector3d& point : map.points(kind)) {
      const Eigen::Vector3d seen = pose.inverse() * point;
      count += std::abs(seen.x() - 5.0) < 0.3 && std::abs(seen.y()) < 0.6 && seen.z() > -0.39 ? 1 : 0;
    }
  }
  return count;
}

inline std::size_t size(const KeyframeVoxelMap& map)
{
  return map.size(FeatureKind::edge) + map.size(FeatureKind::plane);
}

/// A pole before a wall all around.
inline Points poleBeforeWall(float range, float radius, int lines)
{
  constexpr int kColumns = 1800;
  Points points;
  for (int column = 0; column < kColumns; ++column) {
    const float azimuth = kHalfTurn * (2.0F * static_cast<float>(column) / kColumns - 1.0F);
    const float met = std::abs(azimuth - 0.3F) < radius / range ? range : 60.0F;
    for (int line = 0; line < lines; ++line) {
      const float slope = -0.2F + 0.4F * static_cast<float>(line) / static_cast<float>(lines);
      points.emplace_back(met * std::cos(azimuth), met * std::sin(azimuth), met * slope);
    }
  }
  return points;
}

}  // namespace pcl_floam::test
