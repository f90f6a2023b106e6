/// \file rosbag2_folder.h
/// The files of a rosbag2.
#pragma once

#include <filesystem>
#include <vector>

namespace pcl_floam {

/// The recordings in a folder, in order: those that its metadata.yaml names, or all .mcap and .db3 files (also with
/// .zstd) in natural order without one. A file that is named but not there is among them. Empty if the folder is no
/// rosbag2.
[[nodiscard]] std::vector<std::filesystem::path> rosbag2Files(const std::filesystem::path& folder);

}  // namespace pcl_floam
