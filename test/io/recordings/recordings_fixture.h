/// \file recordings_fixture.h
/// Recordings that are written, read, and found fault with.
#pragma once

#include "support/recording_bytes.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <string>

namespace pcl_floam::test {

class Recordings : public ::testing::Test {
protected:
  [[nodiscard]] pcl::PCLPointCloud2 readOne(const std::string& type, const std::string& encoding,
                                            const std::string& message) const
  {
    const ScanSource scans(folder.write("one.mcap", mcapFile(type, encoding, {message})));
    EXPECT_EQ(scans.size(), 1U);
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    return cloud;
  }

  /// What is said of an input when it is opened, or of the first scan that cannot be read.
  [[nodiscard]] std::string problem(const std::string& content, const std::string& topic = "") const
  {
    const auto file = folder.write("bad", content);
    try {
      const ScanSource scans(file, topic);
      pcl::PCLPointCloud2 cloud;
      for (std::size_t i = 0; i < scans.size(); ++i) {
        scans.read(i, cloud);
        (void)viewOf(cloud);
      }
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
      return error.what();
    }
    return "";
  }

  void expectProblem(const std::string& content, const std::string& part, const std::string& topic = "") const
  {
    const std::string told = problem(content, topic);
    EXPECT_NE(told.find(part), std::string::npos) << "told: " << told << "\nexpected: " << part;
  }

  TemporaryFolder folder;
};

inline void expectSixNumbers(const pcl::PCLPointCloud2& cloud)
{
  const CloudView view = viewOf(cloud);
  ASSERT_EQ(view.size, 2U);
  EXPECT_EQ(view.x(0), 1.0F);
  EXPECT_EQ(view.y(0), 2.0F);
  EXPECT_EQ(view.z(0), 3.0F);
  EXPECT_EQ(view.x(1), 4.0F);
  EXPECT_EQ(view.z(1), 6.0F);
}

}  // namespace pcl_floam::test
