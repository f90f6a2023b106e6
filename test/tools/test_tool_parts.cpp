#include "support/random_motion.h"
#include "support/temporary_folder.h"

#include "map_sketch.h"
#include "plot_frame.h"
#include "pose_pairs.h"
#include "result_writer.h"
#include "run_summary.h"
#include "stage_times.h"
#include "trajectory_plot.h"

#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <iomanip>
#include <map>
#include <regex>
#include <sstream>

namespace pcl_floam::tools {
namespace {

using test::randomTwist;
using test::TemporaryFolder;

void expectSame(const SE3& a, const SE3& b, double tolerance = 1e-9)
{
  EXPECT_LT((a.inverse() * b).translation.norm(), tolerance);
  EXPECT_LT(rotationAngle((a.inverse() * b).rotation), tolerance);
}

/// Poses 0.5 s apart of a sensor with constant twist.
Trajectory constantMotion(const Vector6& twist_per_second)
{
  Trajectory trajectory;
  for (int i = 0; i < 5; ++i) {
    trajectory.push_back({10.0 + 0.5 * i, exp(0.5 * i * twist_per_second)});
  }
  return trajectory;
}

TEST(PoseAt, InterpolatesAConstantMotionExactly)
{
  std::mt19937 random(2);
  const Vector6 twist = randomTwist(random, 5.0, 1.0);
  const Trajectory trajectory = constantMotion(twist);
  for (double time = 0.0; time <= 2.0; time += 0.125) {
    const auto pose = poseAt(trajectory, 10.0 + time);
    ASSERT_TRUE(pose.has_value()) << time;
    expectSame(*pose, exp(time * twist));
  }
}

TEST(PoseAt, GuessesNothingOutsideOrInGaps)
{
  Trajectory trajectory = constantMotion(Vector6::Zero());
  EXPECT_FALSE(poseAt(trajectory, 9.999).has_value());
  EXPECT_FALSE(poseAt(trajectory, 12.001).has_value());
  EXPECT_FALSE(poseAt({}, 0.0).has_value());
  trajectory.push_back({20.0, SE3()});
  EXPECT_FALSE(poseAt(trajectory, 15.0).has_value());
  EXPECT_TRUE(poseAt(trajectory, 20.0).has_value());
}

TEST(RequireRisingStamps, RefusesTimesThatStandStill)
{
  Trajectory trajectory = constantMotion(Vector6::Zero());
  EXPECT_NO_THROW(requireRisingStamps(trajectory, "file"));
  trajectory[2].stamp = trajectory[1].stamp;
  EXPECT_THROW(requireRisingStamps(trajectory, "file"), FileError);
}

TEST(CameraToLidar, GivesBackTheLidarsOwnPath)
{
  std::mt19937 random(4);
  const SE3 camera_T_lidar = exp(randomTwist(random, 0.5, 1.5));
  std::ostringstream calibration;
  calibration << std::setprecision(12) << "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr:";
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      calibration << ' ' << camera_T_lidar.matrix()(row, column);
    }
  }
  const TemporaryFolder folder;
  const auto file = folder.write("calib.txt", calibration.str() + "\n");
  const Trajectory lidar = constantMotion(randomTwist(random, 5.0, 1.0));
  Trajectory poses = lidar;
  for (StampedPose& pose : poses) {
    pose.world_T_sensor = camera_T_lidar * pose.world_T_sensor * camera_T_lidar.inverse();
  }
  cameraToLidar(file, poses);
  for (std::size_t i = 0; i < lidar.size(); ++i) {
    expectSame(poses[i].world_T_sensor, lidar[i].world_T_sensor, 1e-8);
  }
}

TEST(CameraToLidar, NeedsTheLineTr)
{
  const TemporaryFolder folder;
  Trajectory poses(1);
  EXPECT_THROW(cameraToLidar(folder.write("calib.txt", "P0: 1 0 0\n"), poses), FileError);
  EXPECT_THROW(cameraToLidar(folder.write("calib.txt", "Tr: 1 0 0\n"), poses), FileError);
  EXPECT_THROW(cameraToLidar(folder.path() / "missing.txt", poses), FileError);
}

TEST(ResultWriter, PutsCorrectedPosesInPlaceOfTheLastOnes)
{
  const TemporaryFolder folder;
  std::mt19937 random(5);
  Trajectory expected;
  ResultWriter writer(folder.path() / "result");
  for (std::size_t scan = 0; scan < 7; ++scan) {
    OdometryReport report;
    report.world_T_sensor = exp(randomTwist(random, 5.0, 1.0));
    if (scan == 5) {
      for (std::size_t i = 2; i < 5; ++i) {
        report.corrected_poses.push_back(exp(randomTwist(random, 5.0, 1.0)));
        expected[i].world_T_sensor = report.corrected_poses.back();
      }
    }
    expected.push_back({0.1 * static_cast<double>(scan), report.world_T_sensor});
    writer.write(scan, expected.back().stamp, report);
  }
  for (const Trajectory& written : {writer.written(), readTrajectory(folder.path() / "result" / "poses.kitti.txt"),
                                    readTrajectory(folder.path() / "result" / "poses.tum.txt")}) {
    ASSERT_EQ(written.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expectSame(written[i].world_T_sensor, expected[i].world_T_sensor, 1e-7);
    }
  }
}

TEST(ResultWriter, TellsOfEachScanWhatWasSaidOfItInFullDigits)
{
  const TemporaryFolder folder;
  OdometryReport report;
  report.state = TrackingState::doubtful;
  report.provisional = true;
  report.explained = 0.123456789;
  report.scan_only_deviation = 0.00123456789;
  report.registration.weak_directions.resize(2);
  report.covariance.topLeftCorner<3, 3>() << 1.0, 2.0, 3.0, 2.0, 4.0, 5.0e-12, 3.0, 5.0e-12, 1234567.89;
  report.reason = "a \"wall\", or none";
  ResultWriter(folder.path()).write(17, 0.0, report);
  const std::string content = test::contentOf(folder.path() / "scans.csv");
  EXPECT_EQ(content.substr(content.find('\n') + 1),
            "17,doubtful,1,0.123456789,0.00123456789,2,1,2,3,4,5e-12,1234567.89,\"a \"\"wall\"\", or none\"\n");
}

TEST(TimeStatistics, AreThoseOfTheSamples)
{
  std::vector<StageTimes> times(101);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[(i * 37) % 101].total = static_cast<double>(i);
  }
  const TimeStatistics statistics = timeStatistics(times, kStages.back());
  EXPECT_DOUBLE_EQ(statistics.mean, 50.0);
  EXPECT_DOUBLE_EQ(statistics.median, 50.0);
  EXPECT_DOUBLE_EQ(statistics.p95, 95.0);
  EXPECT_DOUBLE_EQ(statistics.max, 100.0);
  EXPECT_DOUBLE_EQ(timeStatistics({}, kStages.back()).max, 0.0);
}

TEST(UprightCells, AreWallsButNotFloorsOrCeilings)
{
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.05; x < 10.0; x += 0.1) {
    for (double y = 0.05; y < 10.0; y += 0.1) {
      points.emplace_back(x, y, 0.1);
      points.emplace_back(x, y, 3.1);
    }
    for (double z = 0.1; z < 3.0; z += 0.1) {
      points.emplace_back(x, 5.2, z);
    }
  }
  const GroundArea area{Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(10.0, 10.0)};
  const auto cells = uprightCells(points, area, 0.5);
  EXPECT_EQ(cells.size(), 20U);
  for (const Eigen::Vector2d& cell : cells) {
    EXPECT_NEAR(cell.y(), 5.25, 1e-9);
  }
}

TEST(PlotFrame, BothAxesOfTheTopViewHaveOneScale)
{
  for (const Eigen::Vector3d& end : {Eigen::Vector3d(100.0, 3.0, 0.0), Eigen::Vector3d(2.0, 400.0, 0.0),
                                     Eigen::Vector3d(0.0, 0.0, 9.0), Eigen::Vector3d(70.0, -70.0, 0.0)}) {
    const GroundArea path = areaAround({Eigen::Vector3d::Zero(), end});
    const PlotLayout layout = layoutFor(path, true);
    const GroundArea area = fittedTo(path, layout);
    const Panel& panel = layout.top_view;
    const Eigen::Vector2d extent = area.highest - area.lowest;
    EXPECT_NEAR(extent.x() / ((panel.right - panel.left) * layout.width),
                extent.y() / ((panel.top - panel.bottom) * layout.height), 1e-9);
    EXPECT_TRUE(area.contains(Eigen::Vector3d::Zero()));
    EXPECT_TRUE(area.contains(end));
  }
}

/// Where the words of an SVG picture stand, in pixels from its top.
std::map<std::string, double> heightsOfWords(const std::string& svg)
{
  const std::regex text(R"(<g transform="translate\([0-9.]+,([0-9.]+)\)[^>]*>\s*<text>(?:<tspan[^>]*>)?\s*([^<]*))");
  std::map<std::string, double> heights;
  for (std::sregex_iterator word(svg.begin(), svg.end(), text), end; word != end; ++word) {
    heights[(*word)[2]] = std::stod((*word)[1]);
  }
  return heights;
}

TEST(TrajectoryPlot, TheTitleStandsAboveEveryKeyHoweverLongItIs)
{
  constexpr double kLine = 18.0;  // pixels
  for (const Eigen::Vector3d& end : {Eigen::Vector3d(200.0, 3.0, 0.0), Eigen::Vector3d(30.0, 40.0, 0.0)}) {
    TrajectoryPlot plot;
    plot.title = std::string(120, 'w');
    plot.estimate = {SE3(), SE3(Eigen::Matrix3d::Identity(), end)};
    plot.pairs = {plot.estimate, plot.estimate};
    for (double z = 0.0; z < 3.0; z += 0.1) {
      plot.map_points.emplace_back(1.0, 1.0, z);  // a post
    }
    const TemporaryFolder folder;
    ASSERT_EQ(drawTrajectory(plot, folder.path() / "path.svg"), "");
    const auto heights = heightsOfWords(test::contentOf(folder.path() / "path.svg"));
    ASSERT_EQ(heights.count(plot.title), 1U);
    for (const char* entry : {"map", "ground truth", "estimate", "start", "end", "in all", "horizontal"}) {
      ASSERT_EQ(heights.count(entry), 1U) << entry;
      EXPECT_LT(heights.at(plot.title) + kLine, heights.at(entry)) << entry;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::tools
