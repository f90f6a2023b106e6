// What the odometry tool makes of scans, times and folders that are not as they should be.
#include "tools/odometry_tool_fixture.h"

#include <pcl_floam/io/map_io.h>

#include <cstring>
#include <limits>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::OdometryTool;
using test::Outcome;

/// The lines of a text.
std::ptrdiff_t lineCount(const std::string& text)
{
  return std::count(text.begin(), text.end(), '\n');
}

/// One of the fixture's scans as a PCD file with fields of the caller's choice.
class MixedFolder : public OdometryTool {
protected:
  [[nodiscard]] static std::string pcd(const std::string& bin, const std::string& fields, const std::string& sizes,
                                       const std::string& types, std::size_t bytes_after_xyz)
  {
    const std::string points = std::to_string(bin.size() / 16);
    std::string text = "VERSION 0.7\nFIELDS x y z" + fields + "\nSIZE 4 4 4" + sizes + "\nTYPE F F F" + types +
                       "\nWIDTH " + points + "\nHEIGHT 1\nPOINTS " + points + "\nDATA binary\n";
    for (std::size_t i = 0; i < bin.size(); i += 16) {
      text += bin.substr(i, 12) + std::string(bytes_after_xyz, '\0');
    }
    return text;
  }
};

TEST_F(MixedFolder, EveryScanIsReadByItsOwnFields)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    const std::string bin = contentOf(folder.path() / "scans" / (std::to_string(i) + ".bin"));
    const std::string name = "mixed/" + std::to_string(i) + ".pcd";
    switch (i % 4) {
      case 0: folder.write(name, pcd(bin, "", "", "", 0)); break;
      case 1: folder.write(name, pcd(bin, " intensity ring", " 4 2", " F U", 6)); break;
      case 2: folder.write(name, pcd(bin, " timestamp rgb", " 8 4", " F U", 12)); break;
      default: folder.write(name, pcd(bin, " label t id", " 1 4 8", " U U U", 13)); break;
    }
  }
  const Outcome outcome = odometry("mixed -o result --plot none --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);
}

TEST_F(MixedFolder, OneScanWithoutACoordinateIsNamedAndPredicted)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    const std::string bin = contentOf(folder.path() / "scans" / (std::to_string(i) + ".bin"));
    std::string text = pcd(bin, "", "", "", 0);
    text.replace(text.find("x y z"), 5, i == 4 ? "x y w" : "x y z");
    folder.write("mixed/" + std::to_string(i) + ".pcd", text);
  }
  const Outcome outcome = odometry("mixed -o result --plot none --quiet");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(lineCount(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("mixed/4.pcd: line 8: the points have no field 'z'"), std::string::npos) << outcome.err;
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.1);
}

TEST_F(OdometryTool, PointsThatAreNotFiniteOrAbsurdlyFarAreNoPoints)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    const auto file = folder.path() / "scans" / (std::to_string(i) + ".bin");
    std::string bin = contentOf(file);
    const float absurd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30F,
                            -1e30F, 0.0F};
    for (std::size_t point = i; point < bin.size() / 16; point += 50) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::memcpy(bin.data() + 16 * point + 4 * axis, &absurd[point / 50 % 5], sizeof(float));
      }
    }
    folder.write(file, bin);
  }
  const Outcome outcome = odometry("scans -o result --plot none --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);
}

TEST_F(OdometryTool, TimesThatDoNotRiseAreToldAndTheScansTrackedAllTheSame)
{
  folder.write("times.txt", "0\n0.1\n0.2\n0.2\n0.4\n0.3\n0.6\n0.7\n");
  const Outcome outcome = odometry("scans -o result --plot none --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "times.txt: the time of 3.bin is not after that of the scan before, nor are 1 more\n");
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);
}

TEST_F(OdometryTool, TimesThatAreAskedForAndNotThereAreTold)
{
  const Outcome outcome = odometry("scans -o result --plot none --quiet --timing field");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(lineCount(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("0.bin: has no times of the kind that --timing asks for"), std::string::npos)
      << outcome.err;
}

TEST_F(OdometryTool, ResultsAmongTheScansAreRefused)
{
  const Outcome outcome = odometry("scans -o ./scans/../scans");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("is the folder of the scans"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "scans/poses.kitti.txt"));
}

TEST_F(OdometryTool, AnOutputFolderThatExistsKeepsWhatIsNotReplaced)
{
  folder.write("result/notes.txt", "mine");
  folder.write("result/poses.kitti.txt", std::string(100000, 'x'));
  ASSERT_EQ(odometry("scans -o result --plot none --quiet").status, 0);
  EXPECT_EQ(contentOf(folder.path() / "result/notes.txt"), "mine");
  EXPECT_EQ(poses().size(), kScans);
}

TEST_F(OdometryTool, AMapThatGoesOnInItsOwnFolderIsReplacedByTheLargerOne)
{
  ASSERT_EQ(odometry("scans -o result --max-scans 3 --plot none").status, 0);
  const std::size_t before = loadMap(folder.path() / "result").size(FeatureKind::plane);
  ASSERT_EQ(odometry("scans -o result --map result --plot none").status, 0);
  EXPECT_GT(loadMap(folder.path() / "result").size(FeatureKind::plane), before);
}

TEST_F(OdometryTool, AFullDiskIsToldOnceAndTheRestIsWritten)
{
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full here";
  }
  for (const std::string name :
       {"poses.kitti.txt", "poses.tum.txt", "timing.csv", "scans.csv", "summary.json", "map_edges.pcd"}) {
    const auto result = folder.path() / "result";
    std::filesystem::remove_all(result);
    std::filesystem::create_directory(result);
    std::filesystem::create_symlink("/dev/full", result / (name == "map_edges.pcd" ? name + ".part" : name));
    const Outcome outcome = odometry("scans -o result --plot none --quiet --max-scans 3");
    EXPECT_NE(outcome.err.find("result/" + name + ": cannot be written: No space left on device"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(lineCount(outcome.err), 1) << outcome.err;
    if (name == "timing.csv" || name == "scans.csv") {
      EXPECT_EQ(outcome.status, 2);  // its first line did not go through: nothing was done
      continue;
    }
    EXPECT_EQ(outcome.status, 1) << name;
    EXPECT_EQ(lines("timing.csv"), name.rfind("poses", 0) == 0 ? 1 : 4) << name;
    if (name != "map_edges.pcd") {
      EXPECT_FALSE(loadMap(result).empty()) << name;
    }
    if (name != "summary.json") {
      EXPECT_EQ(summary()["scans"]["processed"], name == "map_edges.pcd" ? 3 : 1) << name;
    }
  }
}

}  // namespace
}  // namespace pcl_floam
