#include "plot_frame.h"

#include <algorithm>

namespace pcl_floam::tools {

bool GroundArea::contains(const Eigen::Vector3d& point) const
{
  return point.x() >= lowest.x() && point.x() <= highest.x() && point.y() >= lowest.y() && point.y() <= highest.y();
}

PlotLayout layoutFor(const GroundArea& path, bool with_error)
{
  constexpr double kWide = 1.5;
  const Eigen::Vector2d extent = path.highest - path.lowest;
  PlotLayout layout;
  if (extent.x() > kWide * extent.y()) {
    layout.width = 1100;
    layout.height = 800;
    layout.top_view = {0.07, 0.97, 0.44, 0.94};
    layout.height_plot = {0.07, with_error ? 0.48 : 0.97, 0.075, 0.33};
    layout.error_plot = {0.56, 0.97, 0.075, 0.33};
  } else {
    layout.width = 1300;
    layout.height = 760;
    layout.top_view = {0.055, 0.565, 0.08, 0.94};
    layout.height_plot = {0.64, 0.98, with_error ? 0.575 : 0.08, 0.94};
    layout.error_plot = {0.64, 0.98, 0.08, 0.445};
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
  const double margin = std::max(1.0, 0.06 * (area.highest - area.lowest).maxCoeff());
  area.lowest.array() -= margin;
  area.highest.array() += margin;
  return area;
}

GroundArea fittedTo(const GroundArea& area, const PlotLayout& layout)
{
  const Panel& panel = layout.top_view;
  const Eigen::Vector2d pixels((panel.right - panel.left) * layout.width, (panel.top - panel.bottom) * layout.height);
  const Eigen::Vector2d middle = 0.5 * (area.lowest + area.highest);
  const double meters_per_pixel = (area.highest - area.lowest).cwiseQuotient(pixels).maxCoeff();
  GroundArea fitted;
  fitted.lowest = middle - 0.5 * meters_per_pixel * pixels;
  fitted.highest = middle + 0.5 * meters_per_pixel * pixels;
  return fitted;
}

}  // namespace pcl_floam::tools
