/// \file map_picture.h
/// The map as a picture: seen from above at a slant, coloured by height, shaded at depth edges. Needs no display.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pcl_floam::tools {

/// Rows from the top, three bytes a pixel.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  [[nodiscard]] std::array<std::uint8_t, 3> pixel(int x, int y) const
  {
    const std::size_t first =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[first], rgb[first + 1], rgb[first + 2]};
  }
};

/// What is drawn: the map's points and the path through it, both in m.
struct MapScene {
  std::vector<Eigen::Vector3d> map;
  std::vector<Eigen::Vector3d> path;
  /// m above the highest point of the path; what is higher is cut off, so that one looks into halls and rooms.
  double cut = 2.5;
  double point_size = 0.25;  ///< m, about the map's voxels
};

/// \param width, height pixels, at least 16
[[nodiscard]] Picture renderMap(const MapScene& scene, int width = 1400, int height = 1000);

/// Renders and writes a PNG file.
/// \return empty, or in one line why there is none
[[nodiscard]] std::string drawMap(const MapScene& scene, const std::filesystem::path& image);

}  // namespace pcl_floam::tools
