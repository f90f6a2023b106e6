#include "support/temporary_folder.h"

#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace pcl_floam {
namespace {

using test::TemporaryFolder;

std::string bytesOf(const std::vector<float>& numbers)
{
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

/// What an action throws as FileError; empty if nothing.
template <typename Action>
std::string reasonOfAction(const Action& action)
{
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

class ScanFolder : public ::testing::Test {
protected:
  void addScans(const std::vector<std::string>& names) const
  {
    for (const std::string& name : names) {
      folder.write(name, bytesOf({1.0F, 2.0F, 3.0F, 4.0F}));
    }
  }
  [[nodiscard]] std::vector<std::string> listed(const std::string& subfolder = "") const
  {
    const ScanSource source(folder.path() / subfolder);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < source.size(); ++i) {
      names.push_back(source.path(i).filename().string());
    }
    return names;
  }
  [[nodiscard]] std::string problem(const std::string& subfolder = "") const
  {
    return reasonOfAction([&] { (void)ScanSource(folder.path() / subfolder); });
  }
  TemporaryFolder folder;
};

TEST_F(ScanFolder, NamesAreInNaturalOrder)
{
  addScans({"scan10.bin", "scan2.bin", "scan1.bin", "scan0003.bin", "scan99999999999999999999999.bin",
            "scan99999999999999999999998.bin", "scan.bin"});
  const std::vector<std::string> expected = {"scan.bin",
                                             "scan1.bin",
                                             "scan2.bin",
                                             "scan0003.bin",
                                             "scan10.bin",
                                             "scan99999999999999999999998.bin",
                                             "scan99999999999999999999999.bin"};
  EXPECT_EQ(listed(), expected);
}

TEST_F(ScanFolder, OnlyScansCount)
{
  addScans({"b.BIN", "a.bin", "._a.bin", "notes.txt", "folder.bin/inner.bin"});
  const std::vector<std::string> expected = {"a.bin", "b.BIN"};
  EXPECT_EQ(listed(), expected);
}

TEST_F(ScanFolder, ADanglingLinkIsAScanThatCannotBeRead)
{
  addScans({"0.bin"});
  std::filesystem::create_symlink("nowhere", folder.path() / "1.bin");
  const ScanSource source(folder.path());
  ASSERT_EQ(source.size(), 2U);
  pcl::PCLPointCloud2 cloud;
  EXPECT_NO_THROW(source.read(0, cloud));
  EXPECT_THROW(source.read(1, cloud), FileError);
}

TEST_F(ScanFolder, AKittiSequenceIsFoundBelowItsFolder)
{
  addScans({"sequence/velodyne/0.bin", "drive/velodyne_points/data/0.bin"});
  EXPECT_EQ(ScanSource(folder.path() / "sequence").folder(), folder.path() / "sequence" / "velodyne");
  EXPECT_EQ(listed("drive").size(), 1U);
}

TEST_F(ScanFolder, FoldersWithoutOneKindOfScansAreErrors)
{
  EXPECT_NE(problem().find("has no .pcd or .bin file"), std::string::npos);
  addScans({"0.bin", "0.pcd"});
  EXPECT_NE(problem().find("both"), std::string::npos);
  EXPECT_NE(problem("missing").find("no such folder"), std::string::npos);
  folder.write("notes.txt", "no scan\n");
  EXPECT_NE(problem("notes.txt").find("is no scan"), std::string::npos);
}

TEST_F(ScanFolder, OneFileIsOneScan)
{
  addScans({"0.bin", "1.bin"});
  const ScanSource source(folder.path() / "1.bin");
  ASSERT_EQ(source.size(), 1U);
  EXPECT_EQ(source.name(0), "1.bin");
  EXPECT_EQ(source.folder(), folder.path());
  pcl::PCLPointCloud2 cloud;
  source.read(0, cloud);
  EXPECT_EQ(cloud.width, 1U);
}

TEST_F(ScanFolder, TimesAreBesideTheScansOrAbove)
{
  addScans({"scans/0.bin", "scans/1.bin"});
  EXPECT_FALSE(ScanSource(folder.path() / "scans").stamp(0).has_value());
  folder.write("times.txt", "0.5\r\n1.5e0\n\n");
  EXPECT_EQ(ScanSource(folder.path() / "scans").stamp(1), 1.5);
  EXPECT_EQ(ScanSource(folder.path() / "scans/").stamp(0), 0.5);
  folder.write("scans/times.txt", "7\n8\n");
  EXPECT_EQ(ScanSource(folder.path() / "scans").stamp(0), 7.0);
}

TEST_F(ScanFolder, TimesThatDoNotFitAreErrors)
{
  addScans({"0.bin", "1.bin"});
  folder.write("times.txt", "0\n1\n2\n");
  EXPECT_NE(problem().find("3 times for 2 scans"), std::string::npos);
  folder.write("times.txt", "0\nsoon\n");
  EXPECT_NE(problem().find("line 2"), std::string::npos);
  folder.write("times.txt", "0\ninf\n");
  EXPECT_NE(problem().find("line 2"), std::string::npos);
}

class KittiBin : public ::testing::Test {
protected:
  TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
};

TEST_F(KittiBin, PointsAreReadBitByBitAlsoWhenNotFinite)
{
  const std::vector<float> numbers = {1.5F, -2.0F, 3.25F, 0.5F, std::nanf(""), HUGE_VALF, 0.0F, 1.0F};
  readKittiBin(folder.write("0.bin", bytesOf(numbers)), cloud);
  ASSERT_EQ(cloud.width * cloud.height, 2U);
  ASSERT_EQ(cloud.fields.size(), 4U);
  EXPECT_EQ(cloud.fields[3].name, "intensity");
  EXPECT_EQ(std::memcmp(cloud.data.data(), numbers.data(), cloud.data.size()), 0);
}

TEST_F(KittiBin, ACutOffFileIsAnErrorWithItsPosition)
{
  const auto cut = folder.write("0.bin", std::string(35, '\0'));
  EXPECT_NE(reasonOfAction([&] { readKittiBin(cut, cloud); }).find(cut.string() + ": byte 35"), std::string::npos);
  const auto empty = folder.write("1.bin", "");
  EXPECT_NE(reasonOfAction([&] { readKittiBin(empty, cloud); }).find("empty"), std::string::npos);
  EXPECT_THROW(readKittiBin(folder.path() / "missing.bin", cloud), FileError);
  EXPECT_THROW(readKittiBin(folder.path(), cloud), FileError);
}

TEST_F(KittiBin, AnOversizedFileIsRefusedUnread)
{
  const auto file = folder.write("0.bin", "");
  std::filesystem::resize_file(file, 1ULL << 40);  // a hole: it takes no room on the disk
  EXPECT_NE(reasonOfAction([&] { readKittiBin(file, cloud); }).find("has 1099511627776 bytes: too large"),
            std::string::npos);
}

}  // namespace
}  // namespace pcl_floam
