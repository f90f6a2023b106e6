// Where recordings of real lidars are, which are not part of the repository.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace pcl_floam::test {

inline std::filesystem::path dataFolder(const std::string& name)
{
  const char* given = std::getenv("PCL_FLOAM_DATA");
  return std::filesystem::path(given != nullptr ? given : PCL_FLOAM_DEFAULT_DATA) / name;
}

#define SKIP_WITHOUT(folder)                                                                                  \
  if (!std::filesystem::exists(folder)) {                                                                     \
    GTEST_SKIP() << "SKIPPED: no real data at " << (folder) << "; set PCL_FLOAM_DATA to the folder above it"; \
  }

}  // namespace pcl_floam::test
