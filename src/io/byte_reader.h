/// \file byte_reader.h
/// Numbers and texts off the front of foreign bytes, none from beyond their end.
#pragma once

#include <pcl_floam/io/scan_source.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace pcl_floam {

/// What holds for all scans of a topic or sender: none of them can be read.
class UnreadableKind : public FileError {
public:
  using FileError::FileError;
};

/// Where bytes come from, for the messages about them.
struct Origin {
  std::filesystem::path file;
  std::string part;         ///< "" for the file itself, else for example "chunk at byte 4096, "
  std::uint64_t begin = 0;  ///< of the first byte in that part

  [[noreturn]] void fail(std::uint64_t offset, const std::string& reason) const
  {
    throw FileError(file, at(offset) + reason);
  }
  /// \throws UnreadableKind
  [[noreturn]] void refuseKind(std::uint64_t offset, const std::string& reason) const
  {
    throw UnreadableKind(file, at(offset) + reason);
  }

private:
  [[nodiscard]] std::string at(std::uint64_t offset) const
  {
    return part + "byte " + std::to_string(begin + offset) + ": ";
  }
};

/// Reads little-endian numbers (as this machine has them), and texts.
class ByteReader {
public:
  /// \param origin must outlive the reader.
  ByteReader(std::string_view bytes, const Origin& origin) : bytes_(bytes), origin_(&origin) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] const Origin& origin() const { return *origin_; }

  template <typename Number>
  [[nodiscard]] Number number()
  {
    Number value;
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }

  [[nodiscard]] std::string_view take(std::uint64_t count)
  {
    if (count > left()) {
      fail(std::to_string(count) + " bytes should follow, but only " + std::to_string(left()) + " are left");
    }
    const std::string_view taken = bytes_.substr(position_, count);
    position_ += count;
    return taken;
  }

  /// What has its length, of type \p Length, before it.
  template <typename Length = std::uint32_t>
  [[nodiscard]] std::string_view counted()
  {
    return take(number<Length>());
  }

  void skip(std::uint64_t count) { (void)take(count); }

  [[noreturn]] void fail(const std::string& reason) const { origin_->fail(position_, reason); }
  [[noreturn]] void refuseKind(const std::string& reason) const { origin_->refuseKind(position_, reason); }

private:
  std::string_view bytes_;
  const Origin* origin_;
  std::size_t position_ = 0;
};

}  // namespace pcl_floam
