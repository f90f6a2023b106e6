// Recordings as our own test writes them: what a file may hold by its specification, and what it must not.
#include "support/recording_bytes.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

constexpr const char* kCloud = "sensor_msgs/msg/PointCloud2";

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

void expectSixNumbers(const pcl::PCLPointCloud2& cloud)
{
  const CloudView view = viewOf(cloud);
  ASSERT_EQ(view.size, 2U);
  EXPECT_EQ(view.x(0), 1.0F);
  EXPECT_EQ(view.y(0), 2.0F);
  EXPECT_EQ(view.z(0), 3.0F);
  EXPECT_EQ(view.x(1), 4.0F);
  EXPECT_EQ(view.z(1), 6.0F);
}

TEST_F(Recordings, PointCloudsOfEitherRosAndEitherByteOrderAreTheSame)
{
  expectSixNumbers(readOne(kCloud, "cdr", pointCloud2({})));
  expectSixNumbers(readOne("sensor_msgs/PointCloud2", "ros1", pointCloud2({}, MessageBytes(false))));
  expectSixNumbers(readOne(kCloud, "cdr", pointCloud2({}, MessageBytes(true, true))));
}

TEST_F(Recordings, BigEndianPointsAreTurnedRound)
{
  CloudShape shape;
  shape.big_endian = true;
  for (std::size_t i = 0; i < shape.data.size(); i += 4) {
    std::swap(shape.data[i], shape.data[i + 3]);
    std::swap(shape.data[i + 1], shape.data[i + 2]);
  }
  expectSixNumbers(readOne(kCloud, "cdr", pointCloud2(shape)));
}

TEST_F(Recordings, Float64CoordinatesAreReadAsFloat)
{
  for (const bool big_endian : {false, true}) {
    CloudShape shape{2, 1, 26, 52, 8, big_endian, true, ""};  // 26 bytes: of no use to any processor's alignment
    for (int i = 1; i <= 6; ++i) {
      const std::string bytes = bytesOf(static_cast<double>(i));
      shape.data += (big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes) + (i % 3 == 0 ? "##" : "");
    }
    expectSixNumbers(readOne(kCloud, "cdr", pointCloud2(shape)));
  }
}

TEST_F(Recordings, BytesBetweenRowsAreTakenOut)
{
  CloudShape shape;
  shape.width = 1;
  shape.height = 2;
  shape.row_step = 17;
  shape.data.insert(12, 5, '#');
  const pcl::PCLPointCloud2 cloud = readOne(kCloud, "cdr", pointCloud2(shape));
  expectSixNumbers(cloud);
  EXPECT_EQ(cloud.row_step, 12U);
}

TEST_F(Recordings, CloudsThatContradictThemselvesAreRefused)
{
  CloudShape shape;
  shape.width = 3;
  expectProblem(mcapFile(kCloud, "cdr", {pointCloud2(shape)}), "24 bytes for 3 x 1 points");
  shape = {};
  shape.z_offset = 9;
  expectProblem(mcapFile(kCloud, "cdr", {pointCloud2(shape)}), "field 'z' ends at byte 13");
  shape.z_offset = 0xFFFFFFFFU;
  expectProblem(mcapFile(kCloud, "cdr", {pointCloud2(shape)}), "field 'z' ends");
  shape = {};
  shape.width = 0xFFFFFFFFU;
  shape.height = 0xFFFFFFFFU;
  expectProblem(mcapFile(kCloud, "cdr", {pointCloud2(shape)}), "more points than PCL can count");
}

TEST_F(Recordings, AMessageCutAnywhereIsToldNeverReadBeyond)
{
  const std::string message = pointCloud2({});
  for (std::size_t bytes = 0; bytes + 1 < message.size(); ++bytes) {
    EXPECT_NE(problem(mcapFile(kCloud, "cdr", {message.substr(0, bytes)})), "") << bytes;
  }
}

TEST_F(Recordings, AFileCutAnywhereGivesTheScansBeforeAndThenTheReason)
{
  const std::string message = pointCloud2({});
  const std::string whole = mcapFile(kCloud, "cdr", {message, message, message});
  ASSERT_EQ(problem(whole), "");
  for (std::size_t bytes = 0; bytes + 40 < whole.size(); bytes += 3) {
    EXPECT_NE(problem(whole.substr(0, bytes)), "") << bytes;
  }
  const ScanSource scans(folder.write("cut.mcap", whole.substr(0, whole.size() - 150)));
  ASSERT_EQ(scans.size(), 3U) << "two scans, and the place of the damage";
  pcl::PCLPointCloud2 cloud;
  scans.read(1, cloud);
  expectSixNumbers(cloud);
  EXPECT_THROW(scans.read(2, cloud), FileError);
}

TEST_F(Recordings, TheStampIsTheMessagesOwn)
{
  const ScanSource scans(folder.write("0.mcap", mcapFile(kCloud, "cdr", {pointCloud2({})})));
  EXPECT_EQ(scans.stamp(0), 1700000000.5);
  EXPECT_EQ(scans.name(0), "0.mcap scan 0");
}

TEST_F(Recordings, LivoxMessagesTake19Bytes)
{
  for (const bool cdr : {false, true}) {
    MessageBytes message(cdr);
    message.header()
        .number(std::uint64_t{0})
        .number(std::uint32_t{2})
        .number(std::uint8_t{1})
        .raw(std::string(3, '\0'));
    message.number(std::uint32_t{2});
    for (int i = 0; i < 2; ++i) {
      const auto n = static_cast<float>(3 * i);
      message.number(static_cast<std::uint32_t>(1000 * i)).number(n + 1.0F).number(n + 2.0F).number(n + 3.0F);
      message.number(std::uint8_t{200}).number(std::uint8_t{16}).number(static_cast<std::uint8_t>(i));
    }
    const std::string type = cdr ? "livox_ros_driver2/msg/CustomMsg" : "livox_ros_driver/CustomMsg";
    const pcl::PCLPointCloud2 cloud = readOne(type, cdr ? "cdr" : "ros1", message.bytes());
    expectSixNumbers(cloud);
    const CloudView view = viewOf(cloud);
    EXPECT_EQ(view.time_name, "offset_time");
    EXPECT_EQ(view.time.read(view.point(1)), 1000.0);
    EXPECT_EQ(view.ring.read(view.point(1)), 1.0);
    EXPECT_EQ(view.intensity.read(view.point(0)), 200.0);
    expectProblem(mcapFile(type, cdr ? "cdr" : "ros1", {message.bytes().substr(0, message.bytes().size() - 2)}),
                  "for 2 points");
  }
}

TEST_F(Recordings, WhatHoldsNoScansIsToldWithWhatThereIs)
{
  expectProblem(mcapFile("sensor_msgs/msg/Imu", "cdr", {"x"}), "/points (sensor_msgs/msg/Imu, 1 messages)");
  expectProblem(mcapFile("foxglove.PointCloud", "protobuf", {"x"}), "foxglove.PointCloud");
  expectProblem(mcapFile(kCloud, "cdr", {}), "has no message");
  expectProblem(mcapFile(kCloud, "cdr", {pointCloud2({})}), "has no topic '/other'", "/other");
}

TEST_F(Recordings, OfSeveralTopicsOneMustBeNamed)
{
  std::string file = mcapFile(kCloud, "cdr", {pointCloud2({})});
  const std::string second = mcapRecord(4, bytesOf(std::uint16_t{2}) + bytesOf(std::uint16_t{1}) + counted("/rear") +
                                               counted("cdr") + counted("")) +
                             mcapMessage(2, 0, pointCloud2({}));
  file.insert(file.size() - 8 - 29 - 13, second);
  expectProblem(file, "/points (sensor_msgs/msg/PointCloud2, 1 messages), /rear");
  EXPECT_EQ(problem(file, "/rear"), "");
}

class Bags : public Recordings {
protected:
  static std::string connection()
  {
    return bagRecord(7, bagField("conn", bytesOf(std::uint32_t{0})) + bagField("topic", "/points"),
                     bagField("topic", "/points") + bagField("type", "sensor_msgs/PointCloud2"));
  }
  static std::string message()
  {
    return bagRecord(2, bagField("conn", bytesOf(std::uint32_t{0})) + bagField("time", bytesOf(std::uint64_t{5})),
                     pointCloud2({}, MessageBytes(false)));
  }
  static std::string bag(const std::string& records, std::uint64_t index, std::uint32_t chunks,
                         const std::string& more = "")
  {
    std::string infos;
    for (std::uint32_t i = 0; index != 0 && i < chunks; ++i) {
      infos += bagRecord(6, bagField("ver", bytesOf(std::uint32_t{1})), "");
    }
    return "#ROSBAG V2.0\n" +
           bagRecord(3,
                     bagField("index_pos", bytesOf(index)) + bagField("conn_count", bytesOf(std::uint32_t{1})) +
                         bagField("chunk_count", bytesOf(chunks)) + more,
                     "") +
           records + infos;
  }
  static std::string chunk(const std::string& records, const std::string& compression = "none", int longer = 0)
  {
    return bagRecord(
        5,
        bagField("compression", compression) +
            bagField("size", bytesOf(static_cast<std::uint32_t>(static_cast<int>(records.size()) + longer))),
        records);
  }
  static std::string index(std::uint32_t offset)
  {
    return bagRecord(4,
                     bagField("ver", bytesOf(std::uint32_t{1})) + bagField("conn", bytesOf(std::uint32_t{0})) +
                         bagField("count", bytesOf(std::uint32_t{1})),
                     bytesOf(std::uint64_t{5}) + bytesOf(offset));
  }
  const std::string records = connection() + message();
  const std::string indexed = chunk(records) + index(static_cast<std::uint32_t>(connection().size()));
};

TEST_F(Bags, WithAndWithoutIndexGiveTheSame)
{
  EXPECT_EQ(problem(bag(indexed + connection(), 1, 1)), "");
  EXPECT_EQ(problem(bag(chunk(records), 1, 1)), "");
  const ScanSource scans(folder.write("0.bag", bag(indexed, 0, 0)));
  ASSERT_EQ(scans.size(), 2U) << "one scan, and the missing index";
  pcl::PCLPointCloud2 cloud;
  scans.read(0, cloud);
  expectSixNumbers(cloud);
  expectProblem(bag(indexed, 0, 0), "the bag has no index");
}

TEST_F(Bags, AFolderOfTheirPartsIsOneRecording)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  folder.write("parts/drive_9.bag", whole);
  folder.write("parts/drive_10.bag", whole);
  const ScanSource scans(folder.path() / "parts");
  EXPECT_EQ(scans.format(), ScanFormat::rosbag1);
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans.path(0).filename(), "drive_9.bag");
  EXPECT_EQ(scans.path(1).filename(), "drive_10.bag");
  folder.write("parts/drive_9.orig.bag", whole);
  EXPECT_EQ(ScanSource(folder.path() / "parts").size(), 2U) << "what reindexing leaves";
  folder.write("parts/0.bin", std::string(16, 'x'));
  EXPECT_EQ(ScanSource(folder.path() / "parts").format(), ScanFormat::kitti_bin) << "taken out of the bag";
}

TEST_F(Bags, AChunkThatIsNotAsItsHeaderSaysIsTold)
{
  expectProblem(bag(chunk(records, "none", 1), 1, 1), "it should be of");
  expectProblem(bag(indexed, 1, 2), "has 1 chunks and an index of 2");
  expectProblem(bag(chunk(records) + index(0) + connection(), 1, 1), "the index does not tell this message");
  const auto first = static_cast<std::uint32_t>(connection().size());
  expectProblem(bag(chunk(records + message()) + index(first) + connection(), 1, 1),
                "the index does not tell this message");
  expectProblem(bag(chunk(connection()) + index(first) + connection(), 1, 1), "a message that is not there");
}

TEST_F(Bags, UnknownCompressionAndEncryptionAreToldByName)
{
  expectProblem(bag(chunk(records, "lzma"), 1, 1), "compression 'lzma' is not known");
  expectProblem(bag(indexed, 1, 1, bagField("encryptor", "rosbag/AesCbcEncryptor")), "is encrypted (rosbag/Aes");
  expectProblem("#ROSBAG V1.2\n", "another version than 2.0");
}

TEST_F(Bags, ABagCutAnywhereIsTold)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  ASSERT_EQ(problem(whole), "");
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 2) {
    EXPECT_NE(problem(whole.substr(0, bytes)), "") << bytes;
  }
}

TEST_F(Bags, AnyByteMayBeAnythingAndNothingIsReadBeyond)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  for (std::size_t at = 0; at < whole.size(); at += 2) {
    for (const char value : {'\0', '\xFF'}) {
      std::string changed = whole;
      changed[at] = value;
      EXPECT_NO_THROW((void)problem(changed)) << at;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
