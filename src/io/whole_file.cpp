#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <limits>
#include <system_error>

namespace pcl_floam {

namespace {

/// No cloud that PCL can count is larger; reading what is only asks for memory.
constexpr std::uintmax_t kLargestFile = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::string readWholeFile(const std::filesystem::path& file)
{
  // A folder can be opened as if it were a file; only reading from it fails, without a reason.
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw FileError(file, "is a folder, not a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) {
    throw FileError(file, "cannot be read: " + error.message());
  }
  if (size > kLargestFile) {
    throw FileError(file, "has " + std::to_string(size) + " bytes: too large for a scan, a map or a trajectory");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw FileError::ofSystem(file, "cannot be opened");
  }
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw FileError::ofSystem(file, "byte " + std::to_string(stream.gcount()) + ": reading failed");
  }
  return content;
}

}  // namespace pcl_floam
