/// \file corner.h
/// A corner of a room, as a search and as a sensor that moves sees it.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/surface_registration.h"
#include "support/random_motion.h"
#include "support/seen_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam::test {

/// Two walls and a floor about the origin as functions of the place: exact, with no sampling of their own.
class Corner : public SurfaceSearch {
public:
  explicit Corner(int walls) : walls_(walls) {}

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = Surface();
      for (int axis = 2; axis > 2 - walls_; --axis) {
        if (std::abs(places[i][axis] - kWall) < 1.0) {
          surfaces[i].kind = SurfaceKind::plane;
          surfaces[i].direction = Eigen::Vector3d::Unit(axis);
          surfaces[i].center = places[i];
          surfaces[i].center[axis] = kWall;
          surfaces[i].extent = 0.1;
          surfaces[i].count = 20;
        }
      }
    }
  }

  static constexpr double kWall = -4.0;  // m, on each axis

private:
  int walls_;
};

/// Points on the three walls of a corner, seen by a sensor that moves.
inline std::vector<ScanPoint> sweepOf(const SweepTrajectory& sensor, std::size_t count)
{
  std::mt19937 random(6);
  std::vector<ScanPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d place(uniform(random, 2.5), uniform(random, 2.5), uniform(random, 2.5));
    place[static_cast<int>(i % 3)] = Corner::kWall;
    points[i].time = static_cast<float>(i) / static_cast<float>(count);
    // What the sensor measures is the place seen from its pose of that moment.
    Eigen::Vector3d seen = sensor.pose().inverse() * place;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Eigen::Vector3d off = place - placeOf(sensor, seen, static_cast<double>(points[i].time));
      seen += sensor.pose().rotation.transpose() * off;
    }
    points[i].x = static_cast<float>(seen.x());
    points[i].y = static_cast<float>(seen.y());
    points[i].z = static_cast<float>(seen.z());
  }
  return points;
}

/// From the origin, of which it is known only that it is near.
inline SurfaceProblem problemOf(const std::vector<ScanPoint>& points, const SurfaceSearch& target)
{
  SurfaceProblem problem;
  problem.scan = {&points, &target};
  problem.guess_covariance = 0.1 * Matrix6(Matrix6::Identity());
  problem.prior.covariance = 0.1 * Matrix12(Matrix12::Identity());
  problem.prior.pose_counts = false;
  return problem;
}

}  // namespace pcl_floam::test
