// The tools on recordings: the same scans give the same path, whatever they are kept in.
#include "support/hdl64_bytes.h"
#include "support/recording_bytes.h"
#include "tools/odometry_tool_fixture.h"

#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::Outcome;

class RecordingTools : public test::OdometryTool {
protected:
  RecordingTools()
  {
    for (std::size_t i = 0; i < kScans; ++i) {
      messages.push_back(messageOf(i, i));
    }
    whole = test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", messages);
    folder.write("drive.mcap", whole);
  }
  [[nodiscard]] std::string messageOf(std::size_t scan, std::size_t tenths_of_a_second) const
  {
    test::CloudShape shape;
    shape.data = contentOf(folder.path() / "scans" / (std::to_string(scan) + ".bin"));
    shape.point_step = 16;
    shape.width = static_cast<std::uint32_t>(shape.data.size() / 16);
    test::MessageBytes message(true);
    return test::pointCloud2(shape, message, 1700000000, static_cast<std::uint32_t>(tenths_of_a_second * 100000000));
  }
  [[nodiscard]] Outcome convert(const std::string& arguments) const { return run(PCL_FLOAM_CONVERT, arguments); }
  std::vector<std::string> messages;
  std::string whole;
};

TEST_F(RecordingTools, ThePathIsThatOfTheSameScansInAFolder)
{
  ASSERT_EQ(odometry("scans -o result --pose-instant end --plot none").status, 0);
  const Trajectory expected = poses();
  const Outcome outcome = odometry("drive.mcap -o result --plot none --save-scans saved --ply --grid -0.5,1.0");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Trajectory found = poses();
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_LT((found.back().world_T_sensor.translation - expected.back().world_T_sensor.translation).norm(), 1e-3);
  const Trajectory tum = readTrajectory(folder.path() / "result/poses.tum.txt");
  EXPECT_NEAR(tum.back().stamp, 1700000000.7, 1e-5);

  const ScanSource saved(folder.path() / "saved");
  EXPECT_EQ(saved.size(), kScans);
  EXPECT_NEAR(saved.stamp(7).value(), 1700000000.7, 1e-5);
  EXPECT_EQ(odometry("drive.mcap -o result --plot none --save-scans saved").status, 2) << "other scans are there";
  EXPECT_EQ(contentOf(folder.path() / "result/path.ply").substr(0, 4), "ply\n");
  EXPECT_NE(contentOf(folder.path() / "result/path.ply").find("element vertex 8\n"), std::string::npos);
  EXPECT_EQ(contentOf(folder.path() / "result/map.ply").substr(0, 4), "ply\n");
  EXPECT_NE(contentOf(folder.path() / "result/map.ply").find("property float intensity\n"), std::string::npos);
  EXPECT_EQ(contentOf(folder.path() / "result/grid.pgm").substr(0, 3), "P5\n");
  EXPECT_NE(contentOf(folder.path() / "result/grid.yaml").find("image: grid.pgm"), std::string::npos);
}

TEST_F(RecordingTools, ARecordingThatWasCutOffGivesItsScansAndTheStatusOne)
{
  folder.write("drive.mcap", whole.substr(0, whole.size() - 3000));
  const std::string truth = contentOf(folder.path() / "truth.txt");
  folder.write("truth7.txt", truth.substr(0, truth.rfind('\n', truth.size() - 2) + 1));
  const Outcome outcome = odometry("drive.mcap -o result --plot none");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("cut off"), std::string::npos) << outcome.err;
  EXPECT_EQ(summary()["scans"]["tracked"], kScans - 2);
  EXPECT_EQ(poses().size(), kScans - 1) << "what followed, if anything, has no pose";
  const Outcome judged = odometry("drive.mcap -o result --plot none --ground-truth truth7.txt");
  EXPECT_EQ(judged.status, 1) << judged.err;
  EXPECT_EQ(summary()["accuracy"]["poses"], kScans - 1);

  const Outcome converted = convert("drive.mcap -o converted");
  EXPECT_EQ(converted.status, 1);
  EXPECT_NE(converted.err.find("cut off"), std::string::npos) << converted.err;
  EXPECT_EQ(ScanSource(folder.path() / "converted").size(), kScans - 1);
}

TEST_F(RecordingTools, WhatHoldsNoScanIsToldInOneLineAndNothingIsWritten)
{
  const std::string magic = whole.substr(0, 8);
  const std::string cloud = "sensor_msgs/msg/PointCloud2";
  std::string no_x = test::pointCloud2({});
  no_x[no_x.find(std::string("x\0", 2))] = 'a';
  const std::string no_topic = magic + test::mcapRecord(1, test::counted("") + test::counted("test")) +
                               test::mcapRecord(15, std::string(4, '\0')) + test::mcapRecord(2, std::string(20, '\0')) +
                               magic;
  const std::pair<std::string, std::string> cases[] = {
      {test::mcapFile(cloud, "cdr", {no_x, no_x, no_x}), "no field 'x' of type float32 or float64"},
      {test::mcapFile(cloud, "cdr", {no_x}), "Its fields: a, y, z"},
      {test::mcapFile(cloud, "cdr", {}), "topic '/points' has no message"},
      {test::mcapFile("sensor_msgs/msg/Imu", "cdr", {"x"}), "Its topics: /points (sensor_msgs/msg/Imu"},
      {no_topic, "is empty: no topic was recorded"},
      {magic, "drive.mcap: byte 8: the file ends without its footer"},
      {"#ROSBAG V1.2\n", "drive.mcap: byte 0: is a rosbag of another version"},
      {"", "drive.mcap: the file is empty"}};
  for (const auto& [content, told] : cases) {
    folder.write("drive.mcap", content);
    for (const Outcome& outcome : {odometry("drive.mcap -o result --plot none"), convert("drive.mcap -o result")}) {
      EXPECT_EQ(outcome.status, 2) << told;
      EXPECT_NE(outcome.err.find(told), std::string::npos) << outcome.err << "expected: " << told;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "result")) << told;
    }
  }
}

TEST_F(RecordingTools, ADamagedFirstScanIsNoReasonToRefuseTheOthers)
{
  std::vector<std::string> damaged = messages;
  damaged[0].resize(30);
  folder.write("drive.mcap", test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", damaged));
  EXPECT_EQ(odometry("drive.mcap -o result --plot none").status, 1);
  EXPECT_EQ(summary()["scans"]["tracked"], kScans - 2);
}

TEST_F(RecordingTools, AScanThatCannotBeReadStandsBetweenTheTimesOfItsNeighbours)
{
  std::vector<std::string> damaged = messages;
  damaged[3].resize(30);
  folder.write("drive.mcap", test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", damaged));
  EXPECT_EQ(odometry("drive.mcap -o result --plot none").status, 1);
  const Trajectory tum = readTrajectory(folder.path() / "result/poses.tum.txt");
  ASSERT_EQ(tum.size(), kScans);
  for (std::size_t i = 0; i < kScans; ++i) {
    EXPECT_NEAR(tum[i].stamp, 1700000000.0 + 0.1 * static_cast<double>(i), 1e-5) << i;
  }
}

TEST_F(RecordingTools, TimesAreGuessedBetweenThoseThatAreKnown)
{
  const std::vector<std::size_t> tenths = {0, 1, 3, 4, 6, 7, 8, 9};
  std::vector<std::string> uneven;
  for (std::size_t i = 0; i < kScans; ++i) {
    uneven.push_back(messageOf(i, tenths[i]));
  }
  uneven[0].resize(30);
  uneven[3].resize(30);
  folder.write("drive.mcap", test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", uneven));
  EXPECT_EQ(odometry("drive.mcap -o result --plot none").status, 1);
  const Trajectory tum = readTrajectory(folder.path() / "result/poses.tum.txt");
  ASSERT_EQ(tum.size(), kScans);
  EXPECT_NEAR(tum[0].stamp, 1700000000.0, 1e-5);
  EXPECT_NEAR(tum[3].stamp, 1700000000.45, 1e-5);
  EXPECT_NEAR(tum[4].stamp, 1700000000.6, 1e-5);
}

/// A driver that never sets its clock.
TEST_F(RecordingTools, TimesThatStandStillAreNone)
{
  std::vector<std::string> still;
  for (std::size_t i = 0; i < kScans; ++i) {
    still.push_back(messageOf(i, 0));
  }
  folder.write("drive.mcap", test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", still));
  EXPECT_EQ(odometry("drive.mcap -o result --plot none -q").status, 0);
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);
  EXPECT_NEAR(readTrajectory(folder.path() / "result/poses.tum.txt").back().stamp, 1700000000.7, 1e-5);
}

TEST_F(RecordingTools, TimesThatRunBackAreToldOnceAndCounted)
{
  std::vector<std::string> back;
  for (const std::size_t i : {0U, 1U, 2U, 1U, 4U, 3U, 6U, 7U}) {
    back.push_back(messages[i]);
  }
  folder.write("drive.mcap", test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", back));
  const Outcome outcome = odometry("drive.mcap -o result --plot none -q");
  EXPECT_NE(outcome.err.find("drive.mcap: the time of drive.mcap scan 3 is not after"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("those of 1 more scans"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("scan 5 is not after"), std::string::npos) << outcome.err;
  EXPECT_EQ(poses().size(), kScans);
}

TEST_F(RecordingTools, AnHdl64IsReadWithItsCalibration)
{
  std::vector<test::Hdl64Return> returns;
  folder.write("a.pcap", test::hdl64Capture({6.0, 9.0}, 3 * 348, returns));
  folder.write("db.xml", test::hdl64Xml());
  const Outcome without = convert("a.pcap -o converted");
  if (without.err.find("left out") != std::string::npos) {
    GTEST_SKIP() << "SKIPPED: " << without.err;
  }
  EXPECT_EQ(without.status, 2);
  EXPECT_NE(without.err.find("--calibration"), std::string::npos) << without.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "converted"));
  const Outcome converted = convert("a.pcap --calibration db.xml -o converted -q");
  if (converted.err.find("left out") != std::string::npos) {
    GTEST_SKIP() << "SKIPPED: " << converted.err;
  }
  ASSERT_EQ(converted.status, 0) << converted.err;
  EXPECT_EQ(ScanSource(folder.path() / "converted").size(), 3U);

  EXPECT_EQ(odometry("a.pcap -o result --plot none").status, 2);
  const Outcome outcome = odometry("a.pcap --calibration db.xml -o result --max-scans 1 --plot none");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("64 scan lines by ring field"), std::string::npos) << outcome.out;
  // KITTI's calibration is that of the true poses; without these it is a mistake.
  folder.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(odometry("scans --calibration calib.txt -o result --plot none").status, 2);
  EXPECT_EQ(odometry("scans --calibration calib.txt --ground-truth truth.txt -o result --plot none").status, 0);
}

TEST_F(RecordingTools, ConvertedTheScansAreTheSame)
{
  ASSERT_EQ(convert("drive.mcap -o converted -q").status, 0);
  const ScanSource converted(folder.path() / "converted");
  const ScanSource recorded(folder.path() / "drive.mcap");
  ASSERT_EQ(converted.size(), kScans);
  EXPECT_NEAR(converted.stamp(7).value(), recorded.stamp(7).value(), 1e-6);
  pcl::PCLPointCloud2 one;
  pcl::PCLPointCloud2 other;
  converted.read(7, one);
  recorded.read(7, other);
  ASSERT_EQ(one.width, other.width);
  for (std::size_t i = 0; i < one.width; ++i) {
    ASSERT_EQ(std::memcmp(&one.data[i * one.point_step], &other.data[i * other.point_step], 12), 0);
  }
  EXPECT_EQ(convert("drive.mcap -o converted").status, 2) << "the folder is not empty";
  EXPECT_EQ(convert("drive.mcap").status, 2);
  EXPECT_NE(convert("drive.mcap --list").out.find("/points"), std::string::npos);
}

}  // namespace
}  // namespace pcl_floam
