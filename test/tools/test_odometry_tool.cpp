// Runs the tools as a user does, and looks at their exit status, messages and files.

#include "tools/odometry_tool_fixture.h"

#include <pcl_floam/io/map_io.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::OdometryTool;
using test::Outcome;

TEST_F(OdometryTool, WritesEveryResult)
{
  const Outcome outcome = odometry("scans -o result --ground-truth truth.txt --plot none");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(lines("poses.kitti.txt"), static_cast<std::ptrdiff_t>(kScans));
  EXPECT_EQ(lines("poses.tum.txt"), static_cast<std::ptrdiff_t>(kScans));
  EXPECT_EQ(lines("timing.csv"), static_cast<std::ptrdiff_t>(kScans + 1));
  EXPECT_EQ(lines("scans.csv"), static_cast<std::ptrdiff_t>(kScans + 1));
  const std::string timing = contentOf(folder.path() / "result" / "timing.csv");
  const std::string columns = timing.substr(0, timing.find('\n'));
  EXPECT_EQ(columns.rfind("scan,", 0), 0U);
  EXPECT_EQ(columns.substr(columns.rfind(',')), ",total_ms");
  EXPECT_FALSE(loadMap(folder.path() / "result").empty());
  EXPECT_NE(outcome.out.find("t_rel"), std::string::npos);
  EXPECT_NE(outcome.out.find("ATE"), std::string::npos);
}

TEST_F(OdometryTool, FollowsTheDrive)
{
  ASSERT_EQ(odometry("scans -o result --ground-truth truth.txt --plot none").status, 0);
  const Trajectory trajectory = poses();
  EXPECT_TRUE(trajectory.front().world_T_sensor.matrix().isIdentity());
  EXPECT_NEAR(trajectory.back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);
  EXPECT_LT(summary()["accuracy"]["ate"]["position_m"]["rms"].get<double>(), 0.05);
  EXPECT_EQ(summary()["scans"]["tracked"], kScans - 1);
  EXPECT_EQ(summary()["scans"]["with_weak_directions"], 0);
  for (const auto& sigma : summary()["last_scan"]["position_sigma_m"]) {
    EXPECT_GT(sigma.get<double>(), 0.0);
    EXPECT_LT(sigma.get<double>(), 0.1);
  }
}

/// A quarter turn to the left, and raised: where the sensor drives along its x, the vehicle drives along its y.
TEST_F(OdometryTool, TakesScansInTheFrameOfAVehicle)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    std::string bin = contentOf(folder.path() / "scans" / (std::to_string(i) + ".bin"));
    std::vector<float> values(bin.size() / sizeof(float));
    std::memcpy(values.data(), bin.data(), bin.size());
    for (std::size_t k = 0; k < values.size(); k += 4) {
      const float x = values[k];
      values[k] = 1.0F - values[k + 1];
      values[k + 1] = x;
      values[k + 2] += 1.5F;
    }
    std::memcpy(bin.data(), values.data(), bin.size());
    folder.write("vehicle/" + std::to_string(i) + ".bin", bin);
  }
  const Outcome outcome = odometry("vehicle -o result --sensor-pose 1,0,1.5,0,0,90 --plot none");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(summary()["last_scan"]["structure"], "scan lines");
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), 0.0, 0.05);
  EXPECT_NEAR(poses().back().world_T_sensor.translation.y(), kStep * (kScans - 1), 0.05);
  const nlohmann::json pose = summary()["sensor_pose"];
  EXPECT_NEAR(pose[1][0].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(pose[2][3], 1.5);

  EXPECT_NE(odometry("vehicle -o result --sensor-pose 1,0,1.5").status, 0);
}

TEST_F(OdometryTool, SaysInHowManyScansADirectionWasWeak)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    folder.write("floor/" + std::to_string(i) + ".bin", test::floorScan());
  }
  const Outcome outcome = odometry("floor -o result --engine features --plot none");
  ASSERT_EQ(outcome.status, 1) << outcome.err << outcome.out;
  EXPECT_NE(outcome.out.find("weak directions"), std::string::npos);
  EXPECT_GT(summary()["scans"]["with_weak_directions"], kScans / 2);
}

TEST_F(OdometryTool, SaysWhetherItWorkedFromScanLinesOrSpaceAndWhy)
{
  Outcome outcome = odometry("scans -o result --plot none");
  EXPECT_NE(outcome.out.find("scan lines: 32 scan lines by file order"), std::string::npos) << outcome.out;
  EXPECT_EQ(summary()["last_scan"]["structure"], "scan lines");
  outcome = odometry("scans -o result --sensor solid-state --plot none");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("space: scan lines were not looked for; times by none"), std::string::npos) << outcome.out;
  EXPECT_EQ(summary()["last_scan"]["structure"], "space");
  EXPECT_EQ(summary()["last_scan"]["structure_reason"], "scan lines were not looked for");
  EXPECT_EQ(summary()["settings"]["sensor"], "solid-state");
  EXPECT_NEAR(poses().back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.05);

  // Every third point, and the frame on its side: no lines are left.
  const std::string bin = contentOf(folder.path() / "scans/0.bin");
  std::vector<std::string> points;
  for (std::size_t i = 0; i + 16 <= bin.size(); i += 48) {
    points.push_back(bin.substr(i + 8, 4) + bin.substr(i, 8) + std::string(4, '\0'));
  }
  std::sort(points.begin(), points.end());
  std::string without;
  for (const std::string& point : points) {
    without += point;
  }
  folder.write("none/0.bin", without);
  outcome = odometry("none -o result --engine features --plot none");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("0.bin: not tracked: no scan-line structure was found"), std::string::npos) << outcome.err;
  EXPECT_EQ(odometry("none -o result --plot none").status, 0);
  EXPECT_EQ(odometry("scans -o result --sensor solid-state --engine features").status, 2);
}

TEST_F(OdometryTool, ScansWithoutStampsAreAPeriodApart)
{
  ASSERT_EQ(odometry("scans -o result --scan-period 0.25 --plot none").status, 0);
  const std::string times = contentOf(folder.path() / "result" / "poses.tum.txt");
  const std::size_t last = times.rfind('\n', times.size() - 2) + 1;
  EXPECT_NEAR(std::stod(times.substr(last)), 0.25 * (kScans - 1), 1e-9);
}

TEST_F(OdometryTool, DrawsThePictureIfGnuplotIsThereAndSaysSoIfNot)
{
  const Outcome outcome = odometry("scans -o result --ground-truth truth.txt");
  EXPECT_EQ(outcome.status, 0);
  const std::string picture = contentOf(folder.path() / "result" / "trajectory.svg");
  const bool told = outcome.err.find("gnuplot is not installed") != std::string::npos;
  EXPECT_NE(told, picture.find("</svg>") != std::string::npos);
}

TEST_F(OdometryTool, AScanThatCannotBeReadStopsNothing)
{
  folder.write("scans/3.bin", "not a scan");
  const Outcome outcome = odometry("scans -o result --plot none");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("3.bin: byte 10"), std::string::npos) << outcome.err;
  const Trajectory trajectory = poses();
  ASSERT_EQ(trajectory.size(), kScans);
  EXPECT_NEAR(trajectory[3].world_T_sensor.translation.x(), 3.0 * kStep, 0.1);
  EXPECT_NEAR(trajectory.back().world_T_sensor.translation.x(), kStep * (kScans - 1), 0.1);
  EXPECT_EQ(summary()["scans"]["predicted"], 1);
  EXPECT_EQ(summary()["scans"]["unreadable"][0]["file"], "3.bin");
}

TEST_F(OdometryTool, AFolderOfUnreadableScansStillHasAllPoses)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    folder.write("scans/" + std::to_string(i) + ".bin", "");
  }
  EXPECT_EQ(odometry("scans -o result --ground-truth truth.txt --plot none").status, 1);
  EXPECT_EQ(poses().size(), kScans);
  EXPECT_EQ(summary()["scans"]["not_started"], kScans);
}

TEST_F(OdometryTool, APartOfTheScansIsComparedWithItsOwnPartOfTheTruth)
{
  ASSERT_EQ(odometry("scans -o result --from 2 --max-scans 4 --ground-truth truth.txt --plot none").status, 0);
  EXPECT_EQ(poses().size(), 4U);
  EXPECT_TRUE(poses().front().world_T_sensor.matrix().isIdentity());
  EXPECT_EQ(summary()["accuracy"]["poses"], 4);
  EXPECT_NEAR(summary()["accuracy"]["path_length_m"].get<double>(), 3.0 * kStep, 1e-9);
  EXPECT_LT(summary()["accuracy"]["ate"]["position_m"]["max"].get<double>(), 0.05);
}

TEST_F(OdometryTool, LocalizesInTheMapOfAnEarlierRun)
{
  ASSERT_EQ(odometry("scans -o mapping --compensation none --plot none").status, 0);
  const std::string map_before = contentOf(folder.path() / "mapping" / "map_planes.pcd");
  const Outcome outcome = odometry(
      "scans -o result --from 4 --compensation none --map mapping --localize --initial-pose 1.0,0.2,0,2 --plot none");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Trajectory path = poses();
  ASSERT_EQ(path.size(), kScans - 4);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector3d truth(kStep * static_cast<double>(4 + i), 0.0, 0.0);
    EXPECT_LT((path[i].world_T_sensor.translation - truth).norm(), 0.05) << i;
  }
  EXPECT_EQ(contentOf(folder.path() / "mapping" / "map_planes.pcd"), map_before);
  EXPECT_EQ(odometry("scans -o result2 --map nowhere --localize").status, 2);
  EXPECT_EQ(odometry("scans -o result2 --localize").status, 2);
}

TEST_F(OdometryTool, TruthWithTimesIsFoundByTime)
{
  std::string times;
  std::string truth;
  for (std::size_t i = 0; i < kScans; ++i) {
    times += std::to_string(100.0 + 0.1 * static_cast<double>(i)) + "\n";
  }
  for (int i = -3; i < 40; ++i) {  // twice as many, between the scans' times
    const double stamp = 100.025 + 0.05 * i;
    truth += std::to_string(stamp) + " " + std::to_string(kStep * (stamp - 100.0) / 0.1) + " 0 0 0 0 0 1\n";
  }
  folder.write("times.txt", times);
  folder.write("truth.tum.txt", truth);
  expectAllJudgedBy("truth.tum.txt");
}

/// Numbers of frames, as some write them in the place of times.
TEST_F(OdometryTool, TruthOfOtherTimesIsTakenByNumber)
{
  std::string times;
  std::string truth;
  for (std::size_t i = 0; i < kScans; ++i) {
    times += std::to_string(100.0 + 0.1 * static_cast<double>(i)) + "\n";
    truth += std::to_string(i) + " " + std::to_string(kStep * static_cast<double>(i)) + " 0 0 0 0 0 1\n";
  }
  folder.write("times.txt", times);
  folder.write("truth.tum.txt", truth);
  expectAllJudgedBy("truth.tum.txt");
}

TEST_F(OdometryTool, ABadGridIsRefusedBeforeTheRun)
{
  EXPECT_EQ(odometry("scans -o result --grid 1,0").status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "result"));
}

TEST_F(OdometryTool, EveryBadOptionOrPathGetsOneLineAndStatus2)
{
  folder.write("short.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.write("empty/notes.txt", "no scan");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "SCANS is required"},
      {"scans", "--output is required"},
      {"nowhere -o result", "nowhere: no such folder"},
      {"empty -o result", "has no .pcd or .bin file"},
      {"truth.txt -o result", "is no scan"},
      {"scans -o truth.txt", "truth.txt"},
      {"scans -o result --speed 9", "--speed"},
      {"scans -o result --threads many", "--threads"},
      {"scans -o result --threads 2000", "threads is 2000"},
      {"scans -o result --max-scans -1", "--max-scans"},
      {"scans -o result --from 8", "--from 8"},
      {"scans -o result --scan-period -1", "scan_period is -1"},
      {"scans -o result --sensor sonar", "sonar"},
      {"scans -o result --elevations 1", "2"},
      {"scans -o result --compensation some", "continuous|two-stage|loam|none"},
      {"scans -o result --solver magic", "gauss-newton|ceres"},
      {"scans -o result --solver ceres", "--engine features"},
      {"scans -o result --vertical-correction 90", "vertical_correction is 90"},
      {"scans -o result --voxel-size 0", "voxel_size is 0"},
      {"scans -o result --ground-truth nowhere.txt", "nowhere.txt: cannot be read"},
      {"scans -o result --ground-truth short.txt", "1 poses for 8 scans"},
      {"scans -o result --ground-truth scans/0.bin", "0.bin: line 1"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = odometry(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << arguments << ": " << outcome.err;
  }
}

TEST_F(OdometryTool, HelpNamesEveryChoice)
{
  const Outcome outcome = odometry("--help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* word :
       {"SCANS", "--output", "continuous|two-stage|loam|none", "gauss-newton|ceres", "voxel|kdtree", "vlp16",
        "--ground-truth", "--vertical-correction", "--threads", "--max-scans", "--from", "Exit"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
}

TEST_F(OdometryTool, EveryChoiceRuns)
{
  for (const char* option :
       {"--engine features", "--compensation none", "--compensation loam", "--engine features --solver ceres",
        "--search kdtree", "--engine features --weights printed", "--engine features --weights inverted",
        "--engine features --kernel none", "--planar", "--smoothness vector-sum", "--pose-instant start", "--threads 2",
        "--timing counterclockwise", "--timing none", "--quiet"}) {
    const Outcome outcome = odometry(std::string("scans -o result --plot none --max-scans 3 ") + option);
    EXPECT_EQ(outcome.status, 0) << option << ": " << outcome.err;
    EXPECT_EQ(poses().size(), 3U) << option;
  }
}

}  // namespace
}  // namespace pcl_floam
