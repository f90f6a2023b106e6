/// \file plot_frame.h
/// Where on the picture the panels lie and which part of the world the top view shows.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl_floam::tools {

/// Fractions of the picture, from the lower left.
struct Panel {
  double left = 0.0;
  double right = 1.0;
  double bottom = 0.0;
  double top = 1.0;
};

/// A picture's panels.
struct PlotLayout {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Panel top_view;
  Panel height_plot;
  Panel error_plot;
};

/// A part of the ground plane, m.
struct GroundArea {
  Eigen::Vector2d lowest = Eigen::Vector2d::Zero();
  Eigen::Vector2d highest = Eigen::Vector2d::Zero();

  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;
};

/// Panels below each other for a path that is longer than wide as seen in the picture, else beside each other.
[[nodiscard]] PlotLayout layoutFor(const GroundArea& path, bool with_error);

/// The area around some points, with a margin.
[[nodiscard]] GroundArea areaAround(const std::vector<Eigen::Vector3d>& points);

/// The smallest area around another that has the shape of a panel, so that both axes have one scale.
[[nodiscard]] GroundArea fittedTo(const GroundArea& area, const PlotLayout& layout);

/// m of the ground per pixel of the top view.
[[nodiscard]] double metersPerPixel(const GroundArea& area, const PlotLayout& layout);

}  // namespace pcl_floam::tools
