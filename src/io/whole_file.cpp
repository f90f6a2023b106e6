#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>

#include <fstream>
#include <system_error>

namespace pcl_floam {

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
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw FileError(file, "cannot be opened");
  }
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw FileError(file, "byte " + std::to_string(stream.gcount()) + ": reading failed");
  }
  return content;
}

}  // namespace pcl_floam
