/// \file file_error.h
/// What is thrown where a file cannot be read or written.
#pragma once

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace pcl_floam {

/// A file could not be read or written. `what()` names the file, the place in it, and the reason.
class FileError : public std::runtime_error {
public:
  FileError(std::filesystem::path path, const std::string& reason)
      : std::runtime_error(path.string() + ": " + reason), path_(std::move(path))
  {
  }

  /// An error whose reason the system knows: to be called right after what failed (it reads `errno`).
  [[nodiscard]] static FileError ofSystem(std::filesystem::path path, const std::string& what)
  {
    const int code = errno;
    return {std::move(path), code == 0 ? what : what + ": " + std::generic_category().message(code)};
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

}  // namespace pcl_floam
