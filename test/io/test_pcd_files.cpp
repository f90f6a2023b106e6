#include "io/reason_of_pcd.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/point_types.h>
#include <pcl_floam/io/scan_source.h>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::TemporaryFolder;
using Cloud = pcl::PointCloud<PointXYZIRT>;

enum class Encoding { ascii, binary, binary_compressed };

const char* nameOf(Encoding encoding)
{
  switch (encoding) {
    case Encoding::ascii: return "ascii";
    case Encoding::binary: return "binary";
    case Encoding::binary_compressed: return "binary_compressed";
  }
  return "unknown";
}

Cloud exampleCloud()
{
  Cloud cloud;
  for (int i = 0; i < 40; ++i) {
    const auto n = static_cast<float>(i);
    cloud.push_back(PointXYZIRT(0.125F * n, -n, 1.0F / (n + 1.0F), 255.0F, static_cast<std::uint16_t>(i), 1e-3F * n));
  }
  cloud[7].x = std::nanf("");
  cloud.width = 10;
  cloud.height = 4;
  cloud.is_dense = false;
  return cloud;
}

std::filesystem::path writeWithPcl(const TemporaryFolder& folder, const Cloud& cloud, Encoding encoding)
{
  const auto file = folder.path() / "scan.pcd";
  pcl::PCDWriter writer;
  switch (encoding) {
    case Encoding::ascii: writer.writeASCII(file.string(), cloud, 9); break;
    case Encoding::binary: writer.writeBinary(file.string(), cloud); break;
    case Encoding::binary_compressed: writer.writeBinaryCompressed(file.string(), cloud); break;
  }
  return file;
}

void expectSame(const Cloud& a, const Cloud& b)
{
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(b[i].x)) {
      EXPECT_TRUE(std::isnan(a[i].x));
    } else {
      EXPECT_EQ(a[i].x, b[i].x);
    }
    EXPECT_EQ(a[i].y, b[i].y);
    EXPECT_EQ(a[i].z, b[i].z);
    EXPECT_EQ(a[i].intensity, b[i].intensity);
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].ring, b[i].ring);
  }
}

class PcdEncodings : public ::testing::TestWithParam<Encoding> {
protected:
  TemporaryFolder folder;
};

TEST_P(PcdEncodings, WhatPclWritesReadsBackWithAllFields)
{
  const Cloud written = exampleCloud();
  pcl::PCLPointCloud2 blob;
  readPcd(writeWithPcl(folder, written, GetParam()), blob);
  Cloud read;
  pcl::fromPCLPointCloud2(blob, read);
  expectSame(read, written);
  const CloudView view = viewOf(blob);
  EXPECT_TRUE(view.ring.exists());
  EXPECT_TRUE(view.time.exists());
  EXPECT_TRUE(view.intensity.exists());
}

TEST_P(PcdEncodings, WhatFollowsTheDeclaredPointsIsIgnored)
{
  const Cloud written = exampleCloud();
  const auto file = writeWithPcl(folder, written, GetParam());
  folder.write("scan.pcd", contentOf(file) + std::string(5000, '\0'));
  pcl::PCLPointCloud2 blob;
  readPcd(file, blob);
  Cloud read;
  pcl::fromPCLPointCloud2(blob, read);
  expectSame(read, written);
}

TEST_P(PcdEncodings, EveryTruncationIsAnErrorWithPositionAndReason)
{
  const std::string content = contentOf(writeWithPcl(folder, exampleCloud(), GetParam()));
  // The last number of an ascii file may lose digits unnoticed; PCL pads binary files by nothing.
  const std::size_t longest = GetParam() == Encoding::ascii ? content.rfind(' ') : content.size() - 1;
  for (std::size_t size = longest % 7; size <= longest; size += 7) {
    const std::string reason = reasonOf(folder.write("cut.pcd", content.substr(0, size)));
    EXPECT_NE(reason.find("cut.pcd: "), std::string::npos) << "accepted " << size << " of " << content.size();
    EXPECT_TRUE(size == 0 || reason.find("line ") != std::string::npos || reason.find("byte ") != std::string::npos)
        << reason;
  }
}

TEST_P(PcdEncodings, DamagedFilesAreReadOrRefusedInSilence)
{
  const std::string content = contentOf(writeWithPcl(folder, exampleCloud(), GetParam()));
  std::mt19937 random(17);
  int refused = 0;
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = content;
    for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    pcl::PCLPointCloud2 cloud;
    try {
      readPcd(folder.write("damaged.pcd", damaged), cloud);
      EXPECT_EQ(viewOf(cloud).size, static_cast<std::size_t>(cloud.width) * cloud.height);
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout() + ::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 20);
}

INSTANTIATE_TEST_SUITE_P(All, PcdEncodings,
                         ::testing::Values(Encoding::ascii, Encoding::binary, Encoding::binary_compressed),
                         [](const auto& parameter) { return nameOf(parameter.param); });

}  // namespace
}  // namespace pcl_floam
