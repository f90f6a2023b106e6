/// \file rosbag2_folder.h
/// The files of a recording that was split.
#pragma once

#include <filesystem>
#include <vector>

namespace pcl_floam {

/// The recordings in a folder, in order: those that its metadata.yaml names, or all .mcap and .db3 files (also with
/// .zstd) in natural order without one; else all .bag files where there are no scans beside them. A file that is named
/// but not there is among them. Empty if there are none.
[[nodiscard]] std::vector<std::filesystem::path> rosbag2Files(const std::filesystem::path& folder);

}  // namespace pcl_floam
