#include "map_sketch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace pcl_floam::tools {

namespace {

/// m; points in the same layer do not make a cell upright.
constexpr double kLayerHeight = 0.4;
/// Floor and ceiling are two; what stands has more.
constexpr std::ptrdiff_t kLayersOfUpright = 3;

/// Cell across, cell along, layer.
using Place = std::array<std::int64_t, 3>;

bool sameCell(const Place& a, const Place& b)
{
  return a[0] == b[0] && a[1] == b[1];
}

std::vector<Place> occupiedPlaces(const std::vector<Eigen::Vector3d>& points, const GroundArea& area, double cell)
{
  std::vector<Place> places;
  for (const Eigen::Vector3d& point : points) {
    if (area.contains(point)) {
      places.push_back({static_cast<std::int64_t>(std::floor((point.x() - area.lowest.x()) / cell)),
                        static_cast<std::int64_t>(std::floor((point.y() - area.lowest.y()) / cell)),
                        static_cast<std::int64_t>(std::floor(point.z() / kLayerHeight))});
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

std::vector<Eigen::Vector2d> uprightCells(const std::vector<Eigen::Vector3d>& points, const GroundArea& area,
                                          double cell)
{
  const std::vector<Place> places = occupiedPlaces(points, area, cell);
  std::vector<Eigen::Vector2d> cells;
  for (auto first = places.begin(); first != places.end();) {
    const auto last = std::find_if(first, places.end(), [&](const Place& place) { return !sameCell(*first, place); });
    if (last - first >= kLayersOfUpright) {
      const Eigen::Vector2d index(static_cast<double>((*first)[0]), static_cast<double>((*first)[1]));
      cells.push_back(area.lowest + cell * (index + Eigen::Vector2d::Constant(0.5)));
    }
    first = last;
  }
  return cells;
}

}  // namespace pcl_floam::tools
