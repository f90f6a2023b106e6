#include "occupancy_grid.h"

#include "result_writer.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace pcl_floam::tools {

namespace {

using Cell = Eigen::Vector2i;

constexpr double kGridMargin = 1.0;     ///< m around all that is drawn
constexpr double kMostCells = 1e8;      ///< a picture of 10000 x 10000
constexpr double kFarthestSeen = 20.0;  ///< m from the path: farther, what lies between is not free for certain
constexpr double kPathStep = 0.5;       ///< m of the path between two looks around

class GridMaker {
public:
  GridMaker(const std::vector<Eigen::Vector3d>& map, const std::vector<Eigen::Vector3d>& path,
            const GridSettings& settings)
      : settings_(settings)
  {
    for (const Eigen::Vector3d& point : map) {
      if (point.z() >= settings.lowest && point.z() <= settings.highest) {
        band_.push_back(point.head<2>());
      }
    }
    if (band_.empty()) {
      throw std::invalid_argument("the map has no point in the band of heights of the occupancy grid");
    }
    for (const Eigen::Vector3d& point : path) {
      if (path_.empty() || (point.head<2>() - path_.back()).norm() > kPathStep) {
        path_.push_back(point.head<2>());
      }
    }
    layOut();
  }

  OccupancyGrid make()
  {
    for (const Eigen::Vector2d& point : band_) {
      at(cellOf(point)) = GridCell::occupied;
    }
    for (const Eigen::Vector2d& place : path_) {
      clear(cellOf(place));
      for (const Eigen::Vector2d& point : band_) {
        if ((point - place).squaredNorm() < kFarthestSeen * kFarthestSeen) {
          look(cellOf(place), cellOf(point));
        }
      }
    }
    return grid_;
  }

private:
  void layOut()
  {
    Eigen::Vector2d low = band_.front();
    Eigen::Vector2d high = low;
    for (const auto* points : {&band_, &path_}) {
      for (const Eigen::Vector2d& point : *points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
      }
    }
    grid_.cell = settings_.cell;
    grid_.origin = low.array() - kGridMargin;
    const Eigen::Vector2d cells = ((high - low).array() + 2.0 * kGridMargin) / settings_.cell;
    if (!(cells.prod() < kMostCells)) {
      throw std::invalid_argument("the occupancy grid would be of more than 100 million cells: take larger ones");
    }
    grid_.width = static_cast<std::size_t>(std::ceil(cells.x()));
    grid_.height = static_cast<std::size_t>(std::ceil(cells.y()));
    grid_.cells.assign(grid_.width * grid_.height, GridCell::unknown);
  }

  [[nodiscard]] Cell cellOf(const Eigen::Vector2d& point) const
  {
    return ((point - grid_.origin) / grid_.cell).array().floor().cast<int>();
  }

  GridCell& at(const Cell& cell)
  {
    return grid_.cells[static_cast<std::size_t>(cell.y()) * grid_.width + static_cast<std::size_t>(cell.x())];
  }

  void clear(const Cell& cell)
  {
    if (at(cell) == GridCell::unknown) {
      at(cell) = GridCell::free;
    }
  }

  /// Clears the way to a cell, up to whatever stands in it.
  void look(const Cell& from, const Cell& to)
  {
    const Cell way = to - from;
    const int steps = std::max(std::abs(way.x()), std::abs(way.y()));
    for (int i = 1; i < steps; ++i) {
      const Eigen::Vector2d part = way.cast<double>() * (static_cast<double>(i) / steps);
      const Cell cell = from + part.array().round().cast<int>().matrix();
      if (at(cell) == GridCell::occupied) {
        return;
      }
      at(cell) = GridCell::free;
    }
  }

  GridSettings settings_;
  std::vector<Eigen::Vector2d> band_;
  std::vector<Eigen::Vector2d> path_;
  OccupancyGrid grid_;
};

}  // namespace

void check(const GridSettings& settings)
{
  if (!(settings.lowest < settings.highest) || !(settings.cell > 0.0)) {
    throw std::invalid_argument("the occupancy grid needs a band of heights, lower first, and cells larger than 0");
  }
}

OccupancyGrid makeGrid(const std::vector<Eigen::Vector3d>& map, const std::vector<Eigen::Vector3d>& path,
                       const GridSettings& settings)
{
  check(settings);
  return GridMaker(map, path, settings).make();
}

void writeGrid(const OccupancyGrid& grid, const std::filesystem::path& stem)
{
  std::string picture = "P5\n" + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n";
  for (std::size_t row = grid.height; row-- > 0;) {  // pictures begin at the top
    for (std::size_t column = 0; column < grid.width; ++column) {
      picture += static_cast<char>(grid.cells[row * grid.width + column]);
    }
  }
  writeTextFile(stem.string() + ".pgm", picture);
  std::ostringstream yaml;
  yaml.imbue(std::locale::classic());
  yaml << std::setprecision(9) << "image: " << stem.filename().string()
       << ".pgm\nmode: trinary\nresolution: " << grid.cell << "\norigin: [" << grid.origin.x() << ", "
       << grid.origin.y() << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  writeTextFile(stem.string() + ".yaml", yaml.str());
}

}  // namespace pcl_floam::tools
