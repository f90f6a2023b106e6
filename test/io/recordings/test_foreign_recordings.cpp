// Recordings that other programs wrote: ROS's own rosbag, and the MCAP project's writer. Skipped where they are
// missing.
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::TemporaryFolder;

const std::filesystem::path kScripts = PCL_FLOAM_RECORDING_SCRIPTS;

/// What the scripts write as scan k.
void expectScan(const ScanSource& scans, std::size_t k)
{
  pcl::PCLPointCloud2 cloud;
  scans.read(k, cloud);
  const CloudView view = viewOf(cloud);
  const double number = static_cast<double>(k);
  EXPECT_NEAR(scans.stamp(k).value(), 1.7e9 + 0.1 * number, 1e-6);
  ASSERT_EQ(view.size, 100 + k);
  for (std::size_t i = 0; i < view.size; ++i) {
    const double point = static_cast<double>(i);
    ASSERT_EQ(view.x(i), static_cast<float>(number + 0.25 * point));
    ASSERT_EQ(view.y(i), static_cast<float>(-point));
    ASSERT_EQ(view.z(i), static_cast<float>(0.5 * number));
    ASSERT_EQ(view.ring.read(view.point(i)), static_cast<double>(i % 64));
    ASSERT_EQ(view.time.read(view.point(i)), 0.1 * point / static_cast<double>(view.size));
  }
}

/// A script, its arguments and what it writes.
struct Writer {
  const char* name;
  std::string command;
  ScanFormat format;
};

void PrintTo(const Writer& writer, std::ostream* out)
{
  *out << writer.name;
}

std::string mcap(const std::string& choices)
{
  return "node " + (kScripts / "write_mcap.cjs").string() + " FILE " + choices;
}

std::string bag(const std::string& choices)
{
  return "/usr/bin/python3 " + (kScripts / "write_rosbag1.py").string() + " FILE " + choices;
}

std::string rosbag2(const std::string& choices)
{
  return "python3 " + (kScripts / "write_rosbag2.py").string() + " FILE " + choices;
}

/// Whether a file can be cut off and changed: a rosbag2 is a folder.
bool isOneFile(const Writer& writer)
{
  return writer.format != ScanFormat::rosbag2;
}

/// All that is in a folder, by name.
std::map<std::string, std::string> contentsOf(const std::filesystem::path& folder)
{
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    contents[entry.path().filename().string()] = contentOf(entry.path());
  }
  return contents;
}

class ForeignRecordings : public ::testing::TestWithParam<Writer> {
protected:
  void SetUp() override
  {
    file = folder.path() / "recording";
    std::string command = GetParam().command;
    command.replace(command.find("FILE"), 4, file.string());
    const std::filesystem::path log = folder.path() / "log";
    if (std::system((command + " >" + log.string() + " 2>&1").c_str()) != 0) {
      GTEST_SKIP() << "SKIPPED: the writer is not here: " << contentOf(log);
    }
  }

  /// How many scans can be read before the first that cannot, and what is said of that one.
  static std::size_t readable(const std::filesystem::path& cut, std::string& reason)
  {
    const ScanSource scans(cut);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      try {
        expectScan(scans, i);
      } catch (const FileError& error) {
        reason = error.what();
        return i;
      }
    }
    return scans.size();
  }

  TemporaryFolder folder;
  std::filesystem::path file;
};

TEST_P(ForeignRecordings, GiveAllScansWithAllFields)
{
  const ScanSource scans(file);
  EXPECT_EQ(scans.format(), GetParam().format);
  ASSERT_EQ(scans.size(), 30U);
  for (const std::size_t k : {0U, 1U, 29U, 7U, 8U, 28U}) {
    expectScan(scans, k);
  }
  for (std::size_t k = 0; k < scans.size(); ++k) {
    expectScan(scans, k);
  }
}

TEST_P(ForeignRecordings, ListTheirTopics)
{
  std::size_t with_scans = 0;
  for (const ScanTopic& topic : listTopics(file)) {
    EXPECT_EQ(topic.messages, 30U) << topic.name;
    EXPECT_EQ(topic.has_scans, topic.name == "/lidar/points");
    with_scans += topic.has_scans ? 1 : 0;
  }
  EXPECT_EQ(with_scans, 1U);
  EXPECT_THROW(ScanSource(file, "/chatter"), FileError);
  EXPECT_THROW(ScanSource(file, "/nothing"), FileError);
  EXPECT_EQ(ScanSource(file, "/lidar/points").size(), 30U);
}

TEST_P(ForeignRecordings, CutOffGiveWhatCameBeforeAndThenTheReason)
{
  if (!isOneFile(GetParam())) {
    return;
  }
  const std::string whole = contentOf(file);
  std::size_t before = 0;
  for (std::size_t tenth = 4; tenth < 10; ++tenth) {
    const auto cut = folder.write("cut", whole.substr(0, whole.size() * tenth / 10));
    std::string reason;
    const std::size_t scans = readable(cut, reason);
    EXPECT_GE(scans, before);
    EXPECT_GT(scans, 2 * tenth - 5) << "a chunk holds about seven scans";
    EXPECT_FALSE(reason.empty()) << "after " << scans << " scans";
    EXPECT_NE(reason.find(cut.string()), std::string::npos) << reason;
    before = scans;
  }
}

TEST_P(ForeignRecordings, AByteChangedAnywhereChangesNoScanUnnoticed)
{
  const std::string whole = contentOf(file);
  if (GetParam().name == std::string("mcap_without_chunks") || GetParam().name == std::string("rosbag1_none") ||
      !isOneFile(GetParam())) {
    return;  // they have no checksums
  }
  for (std::size_t at = 13; at < whole.size() * 8 / 10; at += whole.size() / 41) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const auto changed = folder.write("changed", damaged);
    std::string reason;
    std::size_t scans = 0;
    try {
      scans = readable(changed, reason);
    } catch (const FileError& error) {
      reason = error.what();
    }
    EXPECT_TRUE(scans == 30U || !reason.empty()) << "byte " << at << ": " << scans << " scans";
  }
}

/// A rosbag2 of \p state; empty where it cannot be written.
std::filesystem::path writeRosbag2(const TemporaryFolder& folder, const std::string& state)
{
  const std::filesystem::path bag = folder.path() / "bag";
  std::string command = rosbag2(state + " 30");
  command.replace(command.find("FILE"), 4, bag.string());
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0 ? bag : std::filesystem::path();
}

TEST(Rosbag2, ReadingARecordingThatWasKilledChangesNothing)
{
  const TemporaryFolder folder;
  const auto bag = writeRosbag2(folder, "killed");
  if (bag.empty()) {
    GTEST_SKIP() << "SKIPPED: python3 with sqlite3 is not here";
  }
  std::filesystem::remove(bag / "recording_0.db3-shm");
  const auto before = contentsOf(bag);
  ASSERT_EQ(before.count("recording_0.db3-wal"), 1U);
  {
    const ScanSource scans(bag);
    ASSERT_EQ(scans.size(), 30U);
    expectScan(scans, 29);
    EXPECT_EQ(ScanSource(bag / "recording_0.db3").size(), 30U);
  }
  EXPECT_EQ(contentsOf(bag), before);
}

TEST(Rosbag2, CutOffItGivesItsFirstScansAndThenTheReason)
{
  const TemporaryFolder folder;
  const auto bag = writeRosbag2(folder, "closed");
  if (bag.empty()) {
    GTEST_SKIP() << "SKIPPED: python3 with sqlite3 is not here";
  }
  const std::string whole = contentOf(bag / "recording_0.db3");
  const auto cut = folder.write("cut.db3", whole.substr(0, whole.size() / 2));
  const ScanSource scans(cut);
  ASSERT_GT(scans.size(), 5U);
  expectScan(scans, 0);
  expectScan(scans, 3);
  pcl::PCLPointCloud2 cloud;
  EXPECT_THROW(scans.read(scans.size() - 1, cloud), FileError);
}

TEST(Rosbag2, AFileThatIsNamedButNotThereIsToldInItsPlace)
{
  const TemporaryFolder folder;
  const auto bag = writeRosbag2(folder, "closed");
  if (bag.empty()) {
    GTEST_SKIP() << "SKIPPED: python3 with sqlite3 is not here";
  }
  folder.write("bag/metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths:\n    - recording_0.db3\n    - "
               "\"recording 1.db3\"\n  duration:\n    nanoseconds: 1\n");
  const ScanSource scans(bag);
  ASSERT_EQ(scans.size(), 31U);
  expectScan(scans, 29);
  pcl::PCLPointCloud2 cloud;
  try {
    scans.read(30, cloud);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.path().filename(), "recording 1.db3");
  }
}

INSTANTIATE_TEST_SUITE_P(All, ForeignRecordings,
                         ::testing::Values(Writer{"mcap_none", mcap("none chunked 30"), ScanFormat::mcap},
                                           Writer{"mcap_lz4", mcap("lz4 chunked 30"), ScanFormat::mcap},
                                           Writer{"mcap_zstd", mcap("zstd chunked 30"), ScanFormat::mcap},
                                           Writer{"mcap_without_chunks", mcap("none plain 30"), ScanFormat::mcap},
                                           Writer{"rosbag2_closed", rosbag2("closed 30"), ScanFormat::rosbag2},
                                           Writer{"rosbag2_killed", rosbag2("killed 30"), ScanFormat::rosbag2},
                                           Writer{"rosbag2_packed_messages", rosbag2("message 30"),
                                                  ScanFormat::rosbag2},
                                           Writer{"rosbag2_packed_file", rosbag2("file 30"), ScanFormat::rosbag2},
                                           Writer{"rosbag1_none", bag("none 30"), ScanFormat::rosbag1},
                                           Writer{"rosbag1_bz2", bag("bz2 30"), ScanFormat::rosbag1},
                                           Writer{"rosbag1_lz4", bag("lz4 30"), ScanFormat::rosbag1}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace pcl_floam
