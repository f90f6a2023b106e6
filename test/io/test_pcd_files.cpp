#include "support/temporary_folder.h"

#include <pcl_floam/common/cloud_view.h>
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

std::string reasonOf(const std::filesystem::path& file)
{
  pcl::PCLPointCloud2 cloud;
  try {
    readPcd(file, cloud);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
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

/// A header with single lines replaced; a value without text drops its line.
std::string header(const std::string& key = "", const std::string& value = "")
{
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"VERSION", "0.7"},   {"FIELDS", "x y z t"}, {"SIZE", "4 4 4 4"}, {"TYPE", "F F F U"},
      {"COUNT", "1 1 1 1"}, {"WIDTH", "2"},        {"HEIGHT", "1"},     {"VIEWPOINT", "0 0 0 1 0 0 0"},
      {"POINTS", "2"},      {"DATA", "ascii"}};
  std::string text = "# .PCD\n";
  for (const auto& [name, usual] : lines) {
    const std::string& used = name == key ? value : usual;
    text += used.empty() ? "" : name + " " + used + "\n";
  }
  return text;
}

constexpr const char* kTwoPoints = "1 2 3 4\n5 6 7 8\n";

class PcdHeaders : public ::testing::Test {
protected:
  TemporaryFolder folder;
};

TEST_F(PcdHeaders, MistakesAreNamedWithTheirLine)
{
  const std::vector<std::array<std::string, 3>> cases = {{"FIELDS", "x y", "line 4: SIZE has 4 entries for 2 fields"},
                                                         {"FIELDS", "x y w t", "no field 'z'"},
                                                         {"SIZE", "4 4 4 3", "line 4: SIZE '3'"},
                                                         {"SIZE", "4 4 4", "line 4: SIZE has 3 entries for 4 fields"},
                                                         {"TYPE", "F F F Q", "line 5: TYPE 'Q'"},
                                                         {"TYPE", "F F I U", "field 'z' is not one float32"},
                                                         {"COUNT", "1 1 1 0", "line 6: COUNT '0'"},
                                                         {"COUNT", "1 1 1 4000000000", "line 6: COUNT '4000000000'"},
                                                         {"COUNT", "1 1 2 1", "field 'z' is not one float32"},
                                                         {"WIDTH", "-2", "line 7: WIDTH '-2'"},
                                                         {"WIDTH", "3", "WIDTH times HEIGHT is 3, but POINTS is 2"},
                                                         {"HEIGHT", "1e3", "line 8: HEIGHT '1e3'"},
                                                         {"HEIGHT", "2147483647", "WIDTH times HEIGHT is more than"},
                                                         {"POINTS", "99999999999999999999999", "line 10: POINTS"},
                                                         {"VIEWPOINT", "0 0 0 1 0 0", "line 9: VIEWPOINT"},
                                                         {"DATA", "zipped", "line 11: DATA 'zipped'"},
                                                         {"DATA", "", "line 12: no DATA line"},
                                                         {"VERSION", "0.7\nCOLOUR red", "line 3: 'COLOUR'"}};
  for (const auto& [key, value, expected] : cases) {
    const std::string points = key == "DATA" && value.empty() ? "# the end\n\n" : kTwoPoints;
    const std::string reason = reasonOf(folder.write("bad.pcd", header(key, value) + points));
    EXPECT_NE(reason.find(expected), std::string::npos) << key << ' ' << value << ": " << reason;
  }
}

TEST_F(PcdHeaders, ASizeThatTheFileCannotHoldAsksForNoMemory)
{
  const auto tall = [](const std::string& encoding) {
    std::string text = header("DATA", encoding);
    for (const std::string name : {"WIDTH", "POINTS"}) {
      const std::size_t begin = text.find(name);
      text.replace(begin, text.find('\n', begin) - begin, name + " 2000000000");
    }
    return text;
  };
  EXPECT_NE(reasonOf(folder.write("bad.pcd", tall("ascii") + kTwoPoints)), "");
  EXPECT_NE(reasonOf(folder.write("bad.pcd", tall("binary") + kTwoPoints)), "");
  EXPECT_NE(reasonOf(folder.write("bad.pcd", tall("binary_compressed") + kTwoPoints)), "");
}

/// A compressed file of two points whose data are not compressed further: one run of literal bytes.
std::string compressedFile(const std::string& columns, std::uint32_t compressed, std::uint32_t uncompressed,
                           std::string text = header("DATA", "binary_compressed"))
{
  const std::uint32_t sizes[2] = {compressed, uncompressed};
  text.append(reinterpret_cast<const char*>(sizes), sizeof(sizes));
  for (std::size_t i = 0; i < columns.size(); i += 32) {
    const std::string run = columns.substr(i, 32);
    text += static_cast<char>(run.size() - 1);
    text += run;
  }
  return text;
}

TEST_F(PcdHeaders, CompressedDataThatContradictTheHeaderAreErrors)
{
  const std::string columns(32, '\1');
  EXPECT_EQ(reasonOf(folder.write("good.pcd", compressedFile(columns, 33, 32))), "");
  EXPECT_NE(reasonOf(folder.write("bad.pcd", compressedFile(columns, 33, 31))).find("the header asks for 32"),
            std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", compressedFile(columns, 17, 32))).find("damaged"), std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", compressedFile(columns, 34, 32))).find("1 bytes too early"),
            std::string::npos);
}

TEST_F(PcdHeaders, AFewCompressedBytesCannotAskForGigabytes)
{
  std::string text = header("DATA", "binary_compressed");
  text.replace(text.find("WIDTH 2"), 7, "WIDTH 200000000");
  text.replace(text.find("POINTS 2"), 8, "POINTS 200000000");
  const std::string reason =
      reasonOf(folder.write("bad.pcd", compressedFile(std::string(32, '\1'), 33, 3200000000U, text)));
  EXPECT_NE(reason.find("33 compressed bytes cannot hold 3200000000"), std::string::npos) << reason;
}

TEST_F(PcdHeaders, WidePointsThatTheFileCannotHoldAskForNoMemory)
{
  // 300 points of 60000 numbers each would take 72 MB.
  std::string text = header("COUNT", "1 1 1 15000");
  text.replace(text.find("WIDTH 2"), 7, "WIDTH 300");
  text.replace(text.find("POINTS 2"), 8, "POINTS 300");
  std::string points;
  for (int i = 0; i < 300; ++i) {
    points += "1 2 3 4\n";
  }
  const std::string reason = reasonOf(folder.write("bad.pcd", text + points));
  EXPECT_NE(reason.find("the file is too short for 300 points"), std::string::npos) << reason;
}

TEST_F(PcdHeaders, PaddingOfCompressedFilesTakesNoMemory)
{
  std::string text = header("COUNT", "1 1 1 15000");
  text.replace(text.find("x y z t"), 7, "x y z _");
  text.replace(text.find("DATA ascii"), 10, "DATA binary_compressed");
  pcl::PCLPointCloud2 cloud;
  readPcd(folder.write("good.pcd", compressedFile(std::string(24, '\1'), 25, 24, text)), cloud);
  EXPECT_EQ(cloud.data.size(), 24U);
  EXPECT_EQ(cloud.point_step, 12U);
}

TEST_F(PcdHeaders, FieldsOfSeveralElementsKeepTheirPlaces)
{
  std::string text = header("DATA", "binary_compressed");
  text.replace(text.find("FIELDS x y z t"), 14, "FIELDS x n y z");
  text.replace(text.find("TYPE F F F U"), 12, "TYPE F F F F");
  text.replace(text.find("COUNT 1 1 1 1"), 13, "COUNT 1 3 1 1");
  const std::vector<float> columns = {1, 2, 10, 11, 12, 20, 21, 22, 3, 4, 5, 6};  // x, n of three, y, z
  const std::string bytes(reinterpret_cast<const char*>(columns.data()), columns.size() * sizeof(float));
  pcl::PCLPointCloud2 cloud;
  readPcd(folder.write("good.pcd", compressedFile(bytes, 50, 48, text)), cloud);
  const CloudView view = viewOf(cloud);
  ASSERT_EQ(view.size, 2U);
  EXPECT_EQ(view.x(1), 2.0F);
  EXPECT_EQ(view.y(0), 3.0F);
  EXPECT_EQ(view.z(1), 6.0F);
}

TEST_F(PcdHeaders, Float64CoordinatesAreReadAsFloat)
{
  std::string text = header("SIZE", "8 8 8 4");
  pcl::PCLPointCloud2 cloud;
  readPcd(folder.write("wide.pcd", text + "500000.25 2.5 -3 4\n5 6 1e300 8\n"), cloud);
  CloudView view = viewOf(cloud);
  EXPECT_EQ(view.x(0), 500000.25F);
  EXPECT_EQ(view.z(0), -3.0F);
  EXPECT_EQ(view.time.read(view.point(0)), 4.0);
  EXPECT_EQ(view.y(1), 6.0F);
  EXPECT_TRUE(std::isinf(view.z(1)));

  text.replace(text.find("DATA ascii"), 10, "DATA binary");
  const double point[] = {0.1, 0.2, 0.3};
  std::string bytes(reinterpret_cast<const char*>(point), sizeof(point));
  bytes += std::string(4, '\0');
  readPcd(folder.write("wide.pcd", text + bytes + bytes), cloud);
  view = viewOf(cloud);
  ASSERT_EQ(view.size, 2U);
  EXPECT_EQ(view.x(1), 0.1F);
  EXPECT_EQ(view.z(1), 0.3F);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header("TYPE", "I F F U") + "1 2 3 4\n5 6 7 8\n")).find("float64"),
            std::string::npos);
}

TEST_F(PcdHeaders, OptionalLinesMayBeMissing)
{
  for (const char* key : {"VERSION", "COUNT", "HEIGHT", "VIEWPOINT", "POINTS", "WIDTH"}) {
    EXPECT_EQ(reasonOf(folder.write("good.pcd", header(key, "") + kTwoPoints)), "") << key;
  }
}

TEST_F(PcdHeaders, WindowsLineEndsAreAccepted)
{
  std::string text = header() + kTwoPoints;
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 2)) {
    text.insert(i, "\r");
  }
  EXPECT_EQ(reasonOf(folder.write("good.pcd", text)), "");
}

TEST_F(PcdHeaders, AsciiPointsThatAreNoNumbersAreNamedWithTheirLine)
{
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header() + "1 2 3 4\n5 six 7 8\n")).find("line 13: 'six'"),
            std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header() + "1 2 3\n5 6 7 8\n")).find("line 12: only 3 numbers"),
            std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header() + "1 2 3 4 5\n5 6 7 8\n")).find("5 numbers instead of 4"),
            std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header() + "1 2 3 -4\n5 6 7 8\n")).find("field 't'"), std::string::npos);
  EXPECT_NE(reasonOf(folder.write("bad.pcd", header() + "1 2 3 4\n")).find("after 1 of 2 points"), std::string::npos);
  EXPECT_EQ(reasonOf(folder.write("good.pcd", header() + "nan -inf +3 4\n5e0 6 7 8.0\n")), "");
}

TEST_F(PcdHeaders, WideIntegersAreSteppedOver)
{
  // Some drivers store 64-bit nanoseconds, which PCL has had no name for until 1.14.
  std::string text = header("SIZE", "4 4 4 8");
  pcl::PCLPointCloud2 cloud;
  readPcd(folder.write("wide.pcd", text + "1 2 3 1317013366123456789\n5 6 7 8\n"), cloud);
  ASSERT_EQ(cloud.point_step, 20U);
  const CloudView view = viewOf(cloud);
  EXPECT_EQ(view.z(1), 7.0F);
  EXPECT_EQ(cloud.fields.size(), 3U);
}

}  // namespace
}  // namespace pcl_floam
