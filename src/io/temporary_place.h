/// \file temporary_place.h
/// A folder for what has to be unpacked or copied before it can be read.
#pragma once

#include <pcl_floam/io/scan_source.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace pcl_floam {

/// A new folder, removed with all that is in it.
class TemporaryPlace {
public:
  TemporaryPlace()
  {
    std::string name = (std::filesystem::temp_directory_path() / "pcl_floam_XXXXXX").string();
    errno = 0;
    if (mkdtemp(name.data()) == nullptr) {
      throw FileError::ofSystem(name, "no temporary folder can be made");
    }
    path_ = name;
  }
  ~TemporaryPlace()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryPlace(const TemporaryPlace&) = delete;
  TemporaryPlace& operator=(const TemporaryPlace&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

}  // namespace pcl_floam
