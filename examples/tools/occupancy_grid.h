/// \file occupancy_grid.h
/// A floor plan as map servers of ROS read it.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pcl_floam::tools {

/// How a grid is made.
struct GridSettings {
  double lowest = 0.0;   ///< m; points between these heights are in the way
  double highest = 0.0;  ///< m
  double cell = 0.1;     ///< m
};

/// \throws std::invalid_argument unless lowest < highest and cell > 0
void check(const GridSettings& settings);

enum class GridCell : std::uint8_t { occupied = 0, unknown = 205, free = 254 };  ///< values are those of the picture

/// Cells from the lower left corner, row after row.
struct OccupancyGrid {
  std::size_t width = 0;
  std::size_t height = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< m; the lower left corner
  double cell = 0.1;                                 ///< m
  std::vector<GridCell> cells;
};

/// Occupied are cells with a map point in the band of heights; free are those that lie between the sensor's path and
/// such a cell, as far as no other is in between, and those of the path itself; nothing is known of the rest.
/// \throws std::invalid_argument if there is nothing in the band, or the grid would be larger than a picture should be
[[nodiscard]] OccupancyGrid makeGrid(const std::vector<Eigen::Vector3d>& map, const std::vector<Eigen::Vector3d>& path,
                                     const GridSettings& settings);

/// Writes STEM.pgm and STEM.yaml. \throws FileError if one cannot be written.
void writeGrid(const OccupancyGrid& grid, const std::filesystem::path& stem);

}  // namespace pcl_floam::tools
