/// \file path_line.h
/// A smooth line on the ground, measured by the distance along it.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl_floam::simulator {

/// A line in the plane with rounded corners.
class PathLine {
public:
  /// \param waypoints  m, at least two; the line passes near them
  /// \param rounding   m, a corner is rounded over about three times this length, with the curvature rising and
  ///                   falling smoothly; 0 leaves it sharp
  PathLine(const std::vector<Eigen::Vector2d>& waypoints, double rounding);

  [[nodiscard]] double length() const;

  /// The point at \p station metres along the line, moved by \p left metres to its left. Beyond the ends the line
  /// goes straight on.
  [[nodiscard]] Eigen::Vector2d at(double station, double left = 0.0) const;

  /// The line's direction in rad, continuous along it (not wrapped at pi).
  [[nodiscard]] double heading(double station) const;

  /// 1/m, positive to the left.
  [[nodiscard]] double curvature(double station) const;

private:
  static constexpr double kStep = 0.05;  // m between samples: fine enough for the kinks not to be felt

  std::vector<Eigen::Vector2d> points_;
  std::vector<double> headings_;
};

}  // namespace pcl_floam::simulator
