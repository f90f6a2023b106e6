// A factor for example 06: returns are as bright as the map is where they fall.
#pragma once

#include <pcl_floam/odometry/odometry.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

struct BrightnessFactor : pcl_floam::PoseFactor {
  static constexpr double kSide = 0.25;                      // m, of cells that keep the mean of what was seen in them
  static constexpr double kVariance = 30.0 * (12.0 * 12.0);  // of 0 to 255; some 30 returns share a cell and its error
  std::map<std::array<double, 3>, std::pair<double, double>> cells;  // mean, count
  pcl_floam::CloudView scan;  // the present one, as if it were taken in one instant: one point in twenty is enough

  static auto cellOf(const Eigen::Vector3d& p)
  {
    return std::array{std::rint(p.x() / kSide), std::rint(p.y() / kSide), std::rint(p.z() / kSide)};
  }
  double meanAt(const Eigen::Vector3d& place) const  // NaN where nothing was seen
  {
    const auto cell = place.allFinite() ? cells.find(cellOf(place)) : cells.end();
    return cell == cells.end() ? std::nan("") : cell->second.first;
  }

  void learn(const pcl_floam::SE3& world_T_sensor)
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      const Eigen::Vector3d place = world_T_sensor * Eigen::Vector3d(scan.x(i), scan.y(i), scan.z(i));
      if (place.allFinite()) {
        auto& [mean, count] = cells[cellOf(place)];
        mean += (scan.intensityOf(i) - mean) / ++count;
      }
    }
  }

  void addTo(const pcl_floam::SE3& world_T_sensor, pcl_floam::PoseEquations& equations) const override
  {
    for (std::size_t i = 0; i < scan.size; i += 20) {
      const Eigen::Vector3d arm = world_T_sensor.rotation * Eigen::Vector3d(scan.x(i), scan.y(i), scan.z(i));
      const Eigen::Vector3d place = world_T_sensor.translation + arm;
      pcl_floam::Vector6 slope = pcl_floam::Vector6::Zero();
      for (int axis = 0; axis < 3; ++axis) {  // by central differences; none across a surface, where nothing is seen
        const Eigen::Vector3d step = kSide * Eigen::Vector3d::Unit(axis);
        const double rise = meanAt(place + step) - meanAt(place - step);
        slope[axis] = std::isfinite(rise) ? rise / (2.0 * kSide) : 0.0;
      }
      slope.tail<3>() = arm.cross(slope.head<3>());
      if (const double mean = meanAt(place); std::isfinite(mean)) {
        equations.add(mean - scan.intensityOf(i), slope, kVariance);
      }
    }
  }
};
