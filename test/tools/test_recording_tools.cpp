// The tools on recordings: the same scans give the same path, whatever they are kept in.
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
    std::vector<std::string> messages;
    for (std::size_t i = 0; i < kScans; ++i) {
      test::CloudShape shape;
      shape.data = contentOf(folder.path() / "scans" / (std::to_string(i) + ".bin"));
      shape.point_step = 16;
      shape.width = static_cast<std::uint32_t>(shape.data.size() / 16);
      test::MessageBytes message(true);
      messages.push_back(test::pointCloud2(shape, message, 1700000000, static_cast<std::uint32_t>(i * 100000000)));
    }
    whole = test::mcapFile("sensor_msgs/msg/PointCloud2", "cdr", messages);
    folder.write("drive.mcap", whole);
  }
  [[nodiscard]] Outcome convert(const std::string& arguments) const { return run(PCL_FLOAM_CONVERT, arguments); }
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

  EXPECT_EQ(ScanSource(folder.path() / "saved").size(), kScans);
  EXPECT_EQ(contentOf(folder.path() / "result/path.ply").substr(0, 4), "ply\n");
  EXPECT_NE(contentOf(folder.path() / "result/path.ply").find("element vertex 8\n"), std::string::npos);
  EXPECT_EQ(contentOf(folder.path() / "result/map.ply").substr(0, 4), "ply\n");
  EXPECT_EQ(contentOf(folder.path() / "result/grid.pgm").substr(0, 3), "P5\n");
  EXPECT_NE(contentOf(folder.path() / "result/grid.yaml").find("image: grid.pgm"), std::string::npos);
}

TEST_F(RecordingTools, ARecordingThatWasCutOffGivesItsScansAndTheStatusOne)
{
  folder.write("drive.mcap", whole.substr(0, whole.size() - 3000));
  const Outcome outcome = odometry("drive.mcap -o result --plot none");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("cut off"), std::string::npos) << outcome.err;
  EXPECT_EQ(summary()["scans"]["tracked"], kScans - 2);

  const Outcome converted = convert("drive.mcap -o converted");
  EXPECT_EQ(converted.status, 1);
  EXPECT_NE(converted.err.find("cut off"), std::string::npos) << converted.err;
  EXPECT_EQ(ScanSource(folder.path() / "converted").size(), kScans - 1);
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
