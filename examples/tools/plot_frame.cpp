#include "plot_frame.h"

#include <algorithm>

namespace pcl_floam::tools {

namespace {

Eigen::Vector2d topViewPixels(const PlotLayout& layout)
{
  const Panel& panel = layout.top_view;
  return {(panel.right - panel.left) * layout.width, (panel.top - panel.bottom) * layout.height};
}

}  // namespace

bool GroundArea::contains(const Eigen::Vector3d& point) const
{
  return point.x() >= lowest.x() && point.x() <= highest.x() && point.y() >= lowest.y() && point.y() <= highest.y();
}

PlotLayout layoutFor(const GroundArea& path, bool with_error)
{
  constexpr double kWide = 1.5;
  constexpr double kTop = 0.89;  // above it two rows of a key, and the title
  const Eigen::Vector2d extent = path.highest - path.lowest;
  PlotLayout layout;
  if (extent.x() > kWide * extent.y()) {
    layout.width = 1100;
    layout.height = 800;
    layout.top_view = {0.07, 0.97, 0.44, kTop};
    layout.height_plot = {0.07, with_error ? 0.48 : 0.97, 0.075, 0.325};
    layout.error_plot = {0.56, 0.97, 0.075, 0.325};
  } else {
    layout.width = 1300;
    layout.height = 760;
    layout.top_view = {0.055, 0.565, 0.08, kTop};
    layout.height_plot = {0.64, 0.98, with_error ? 0.575 : 0.08, kTop};
    layout.error_plot = {0.64, 0.98, 0.08, 0.42};
  }
  return layout;
}

GroundArea areaAround(const std::vector<Eigen::Vector3d>& points)
{
  GroundArea area;
  if (points.empty()) {
    return area;
  }
  area.lowest = area.highest = points.front().head<2>();
  for (const Eigen::Vector3d& point : points) {
    area.lowest = area.lowest.cwiseMin(point.head<2>());
    area.highest = area.highest.cwiseMax(point.head<2>());
  }
  const double margin = std::max(6.0, 0.06 * (area.highest - area.lowest).maxCoeff());
  area.lowest.array() -= margin;
  area.highest.array() += margin;
  return area;
}

double metersPerPixel(const GroundArea& area, const PlotLayout& layout)
{
  return (area.highest - area.lowest).cwiseQuotient(topViewPixels(layout)).maxCoeff();
}

GroundArea fittedTo(const GroundArea& area, const PlotLayout& layout)
{
  const Eigen::Vector2d middle = 0.5 * (area.lowest + area.highest);
  const Eigen::Vector2d half = 0.5 * metersPerPixel(area, layout) * topViewPixels(layout);
  return {middle - half, middle + half};
}

}  // namespace pcl_floam::tools
