/// \file sqlite_recording.h
/// A rosbag2's .db3 file.
#pragma once

#include "io/recordings/recording.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace pcl_floam {

inline constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

/// Opens a database without changing it or the files beside it: what a recording that was killed left there
/// (`-wal`, `-journal`) is read from a copy.
/// \throws FileError if it cannot be opened, is no rosbag2, or SQLite was left out of this build.
[[nodiscard]] std::unique_ptr<Recording> openSqlite(const std::filesystem::path& file);

}  // namespace pcl_floam
