/// \file reason_of_pcd.h
/// Why a PCD file is refused.
#pragma once

#include <pcl_floam/io/scan_source.h>

#include <filesystem>
#include <string>

namespace pcl_floam {

/// \return empty: it is not
inline std::string reasonOf(const std::filesystem::path& file)
{
  pcl::PCLPointCloud2 cloud;
  try {
    readPcd(file, cloud);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace pcl_floam
