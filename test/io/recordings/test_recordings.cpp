// Recordings as our own test writes them: what a file may hold by its specification, and what it must not.
#include "io/recordings/recordings_fixture.h"
#include "support/recording_bytes.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

constexpr const char* kCloud = "sensor_msgs/msg/PointCloud2";

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

}  // namespace
}  // namespace pcl_floam::test
