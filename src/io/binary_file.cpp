#include "io/binary_file.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace pcl_floam {

namespace {

/// Bytes; small pieces that follow each other are read in one go.
constexpr std::uint64_t kReadAhead = 4096;

/// Bytes; no scan and no chunk has more: a length that is damaged must not ask for the machine's memory.
constexpr std::uint64_t kLargestPiece = 1ULL << 30U;

}  // namespace

BinaryFile::BinaryFile(std::filesystem::path path) : path_(std::move(path))
{
  std::error_code error;
  if (std::filesystem::is_directory(path_, error)) {
    throw FileError(path_, "is a folder, not a file");
  }
  size_ = std::filesystem::file_size(path_, error);
  if (error) {
    throw FileError(path_, "cannot be read: " + error.message());
  }
  errno = 0;
  stream_.open(path_, std::ios::binary);
  if (!stream_) {
    throw FileError::ofSystem(path_, "cannot be opened");
  }
}

std::string_view BinaryFile::view(std::uint64_t position, std::uint64_t count)
{
  if (position > size_ || count > size_ - position) {
    throw FileError(path_, "byte " + std::to_string(size_) + ": the file ends within " + std::to_string(count) +
                               " bytes that begin at byte " + std::to_string(position));
  }
  if (count > kLargestPiece) {
    throw FileError(path_, "byte " + std::to_string(position) + ": a piece of " + std::to_string(count) +
                               " bytes is larger than any scan: the file is damaged");
  }
  if (position >= begin_ && position - begin_ <= buffer_.size() && buffer_.size() - (position - begin_) >= count) {
    return std::string_view(buffer_).substr(position - begin_, count);
  }
  begin_ = position;
  buffer_.resize(std::min(std::max(count, kReadAhead), size_ - position));
  errno = 0;
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(position));
  stream_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (static_cast<std::uint64_t>(stream_.gcount()) != buffer_.size()) {
    buffer_.clear();
    throw FileError::ofSystem(path_, "byte " + std::to_string(position) + ": reading failed");
  }
  return std::string_view(buffer_).substr(0, count);
}

std::string_view BinaryFile::viewUpTo(std::uint64_t position, std::uint64_t count)
{
  return position >= size_ ? std::string_view() : view(position, std::min(count, size_ - position));
}

}  // namespace pcl_floam
