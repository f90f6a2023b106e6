/// \file binary_file.h
/// A large file, read piece by piece.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace pcl_floam {

/// A file of any length, of which only the piece in use is in memory.
class BinaryFile {
public:
  /// \throws FileError if the file is missing, is no file, or cannot be opened.
  explicit BinaryFile(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// The bytes from \p position on, valid until the next call.
  /// \throws FileError if the file ends before, or if it is more than any scan or chunk has.
  [[nodiscard]] std::string_view view(std::uint64_t position, std::uint64_t count);

  /// At most \p count bytes: fewer at the file's end.
  [[nodiscard]] std::string_view viewUpTo(std::uint64_t position, std::uint64_t count);

  /// Gives up the memory of the last view.
  void forget() { buffer_ = std::string(); }

private:
  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  ///< position of the buffer's first byte
  std::string buffer_;
};

}  // namespace pcl_floam
