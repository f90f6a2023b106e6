// What the header of a PCD file may say, and what follows from it.
#include "io/reason_of_pcd.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/point_types.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace pcl_floam {
namespace {

using test::TemporaryFolder;

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
