/// \file whole_file.h
/// A file's bytes in one piece.
#pragma once

#include <filesystem>
#include <string>

namespace pcl_floam {

/// \throws FileError if the file is missing, is no file, or cannot be read to its end.
[[nodiscard]] std::string readWholeFile(const std::filesystem::path& file);

}  // namespace pcl_floam
