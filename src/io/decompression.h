/// \file decompression.h
/// The compressions that recordings use. Each is there if its library was found when this one was built.
#pragma once

#include "io/byte_reader.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace pcl_floam {

enum class Compression : std::uint8_t { none, lz4, zstd, bz2 };

/// The compression of that name ("" or "none", "lz4", "zstd", "bz2").
/// \throws FileError for another name.
[[nodiscard]] Compression compressionOf(std::string_view name, const Origin& origin);

/// Unpacks into \p content, which takes memory only as bytes come out, and at most \p size of them.
/// \param whole the packed bytes are all there: it is an error if they end too early or do not give \p size bytes;
///              without, what they give is enough
/// \throws FileError if the bytes are damaged, or the compression was left out of this build.
void decompress(Compression compression, std::string_view packed, std::uint64_t size, bool whole, const Origin& origin,
                std::string& content);

/// Whether bytes begin as a zstd frame does.
[[nodiscard]] bool isZstd(std::string_view bytes);

/// Unpacks a whole zstd frame of unknown size, as messages of rosbag2 are.
void decompressZstd(std::string_view packed, const Origin& origin, std::string& content);

/// Unpacks a file into another, a piece at a time. \throws FileError as the others
void decompressZstdFile(const std::filesystem::path& packed, const std::filesystem::path& unpacked);

}  // namespace pcl_floam
