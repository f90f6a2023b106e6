/// \file pcd_header.h
/// The header of a PCD file, checked.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam {

/// One field of a PCD file's points.
struct PcdField {
  std::string name;
  char type = 'F';           ///< F floating point, I signed, U unsigned
  std::uint32_t size = 4;    ///< bytes of one element
  std::uint32_t count = 1;   ///< elements
  std::uint32_t offset = 0;  ///< bytes from the start of the point

  [[nodiscard]] std::uint32_t bytes() const { return size * count; }
  /// Filling between other fields. `binary_compressed` files leave it out, and so do we then.
  [[nodiscard]] bool isPadding() const { return name == "_"; }
};

enum class PcdEncoding : std::uint8_t { ascii, binary, binary_compressed };

/// What the lines before the points say.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  std::uint32_t point_bytes = 0;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< translation of VIEWPOINT
  PcdEncoding encoding = PcdEncoding::ascii;
  std::size_t body_begin = 0;  ///< byte at which the points begin
  std::size_t lines = 0;       ///< lines of the header

  [[nodiscard]] std::size_t points() const { return static_cast<std::size_t>(width) * height; }
};

/// Reads and checks the header of a PCD file.
/// \param file    for the error message
/// \param content the whole file
/// \throws FileError with line and reason: a number that is none, sizes that disagree, a type that does not exist,
///         no x, y, z of type float32 or float64.
[[nodiscard]] PcdHeader parsePcdHeader(const std::filesystem::path& file, std::string_view content);

}  // namespace pcl_floam
