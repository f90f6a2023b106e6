/// \file map_io.h
/// Saves the map as PCD files and loads it again.
#pragma once

#include <pcl_floam/io/file_error.h>
#include <pcl_floam/map/keyframe_voxel_map.h>

#include <filesystem>

namespace pcl_floam {

/// Names of the files of a saved map within its folder.
inline constexpr const char* kMapEdgesFile = "map_edges.pcd";
inline constexpr const char* kMapPlanesFile = "map_planes.pcd";

/// Writes the layers of a map as `map_edges.pcd` and `map_planes.pcd` (binary, x y z intensity float32) into a folder,
/// which is created if need be. Files of these names are replaced once the new ones are whole.
///
/// The coordinates are those of the world, unless the map reaches beyond 5 km from the world's origin, where float32
/// would be too coarse: then they are relative to a point of whole metres in the map's middle, which each file gives
/// as the translation of its VIEWPOINT. PCL's viewer and \ref loadMap add it.
///
/// \throws FileError if a file cannot be written.
void saveMap(const KeyframeVoxelMap& map, const std::filesystem::path& folder);

/// Reads a map that \ref saveMap wrote, or two PCD files of the same names from elsewhere.
/// \throws FileError if a file is missing or damaged.
/// \throws std::invalid_argument if a parameter is out of its range.
[[nodiscard]] KeyframeVoxelMap loadMap(const std::filesystem::path& folder, const MapParameters& parameters = {});

}  // namespace pcl_floam
