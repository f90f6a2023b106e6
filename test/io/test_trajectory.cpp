#include "support/random_motion.h"
#include "support/temporary_folder.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::randomTwist;
using test::TemporaryFolder;

Trajectory randomTrajectory(double reach)
{
  std::mt19937 random(11);
  Trajectory trajectory;
  for (int i = 0; i < 50; ++i) {
    trajectory.push_back({1317013366.123456 + 0.1 * i, exp(randomTwist(random, reach, 2.0))});
  }
  return trajectory;
}

std::string reasonOfTrajectory(const std::filesystem::path& file, TrajectoryFormat format = TrajectoryFormat::automatic)
{
  try {
    (void)readTrajectory(file, format);
  } catch (const FileError& error) {
    EXPECT_EQ(error.path(), file);
    return error.what();
  }
  return "";
}

class TrajectoryFormats : public ::testing::TestWithParam<TrajectoryFormat> {
protected:
  TemporaryFolder folder;
};

TEST_P(TrajectoryFormats, WhatIsWrittenReadsBack)
{
  const Trajectory written = randomTrajectory(1e5);
  const auto file = folder.path() / "poses.txt";
  TrajectoryWriter writer(file, GetParam());
  for (const StampedPose& pose : written) {
    writer.write(pose);
  }
  EXPECT_EQ(trajectoryFormat(file), GetParam());
  const Trajectory read = readTrajectory(file);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const SE3 difference = read[i].world_T_sensor.inverse() * written[i].world_T_sensor;
    EXPECT_LT(difference.translation.norm(), 1e-5);  // 13 digits at 100 km
    EXPECT_LT(rotationAngle(difference.rotation), 1e-8);
    const double stamp = GetParam() == TrajectoryFormat::tum ? written[i].stamp : static_cast<double>(i);
    EXPECT_NEAR(read[i].stamp, stamp, 1e-6);
  }
}

TEST_P(TrajectoryFormats, EveryPoseIsInTheFileAsSoonAsItIsWritten)
{
  const auto file = folder.path() / "poses.txt";
  TrajectoryWriter writer(file, GetParam());
  for (std::size_t poses = 1; poses <= 3; ++poses) {
    writer.write({0.1 * static_cast<double>(poses), SE3()});
    EXPECT_EQ(readTrajectory(file).size(), poses);
    EXPECT_EQ(contentOf(file).back(), '\n');
  }
}

TEST_P(TrajectoryFormats, WrittenAgainItGoesOnAfterThat)
{
  std::mt19937 random(9);
  const auto file = folder.path() / "poses.txt";
  TrajectoryWriter writer(file, GetParam());
  writer.write({0.0, SE3()});
  writer.write({0.1, SE3()});
  const Trajectory poses = {{0.0, exp(randomTwist(random, 5.0, 1.0))},
                            {0.1, exp(randomTwist(random, 5.0, 1.0))},
                            {0.2, exp(randomTwist(random, 5.0, 1.0))}};
  writer.writeAgain({poses[0], poses[1]});
  writer.write(poses[2]);
  const Trajectory read = readTrajectory(file);
  ASSERT_EQ(read.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((read[i].world_T_sensor.translation - poses[i].world_T_sensor.translation).norm(), 1e-7) << i;
  }
  std::filesystem::create_directory(file.string() + ".part");
  EXPECT_THROW(writer.writeAgain(poses), FileError);
  EXPECT_EQ(readTrajectory(file).size(), poses.size()) << "what was there stays";
}

TEST_P(TrajectoryFormats, FarFromTheOriginMicrometresAreKept)
{
  const Eigen::Vector3d far_away(1e6 + 0.123456, -1e6 + 0.654321, 100.111222);
  TrajectoryWriter(folder.path() / "poses.txt", GetParam()).write({0.0, SE3(Eigen::Matrix3d::Identity(), far_away)});
  EXPECT_LT((readTrajectory(folder.path() / "poses.txt").front().world_T_sensor.translation - far_away).norm(), 2e-6);
}

TEST_P(TrajectoryFormats, AFileThatCannotBeCreatedIsAnError)
{
  EXPECT_THROW(TrajectoryWriter(folder.path() / "missing" / "poses.txt", GetParam()), FileError);
}

INSTANTIATE_TEST_SUITE_P(Both, TrajectoryFormats, ::testing::Values(TrajectoryFormat::kitti, TrajectoryFormat::tum),
                         [](const auto& parameter) {
                           return parameter.param == TrajectoryFormat::kitti ? "kitti" : "tum";
                         });

class ReadTrajectory : public ::testing::Test {
protected:
  TemporaryFolder folder;
};

TEST_F(ReadTrajectory, KittiRowsAreTheUpperRowsOfThePose)
{
  const auto file = folder.write("poses.txt", "0 -1 0 7  1 0 0 8  0 0 1 9\r\n\n");
  const Trajectory read = readTrajectory(file);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].world_T_sensor.translation, Eigen::Vector3d(7.0, 8.0, 9.0));
  EXPECT_LT((read[0].world_T_sensor * Eigen::Vector3d(1.0, 0.0, 0.0) - Eigen::Vector3d(7.0, 9.0, 9.0)).norm(), 1e-12);
}

TEST_F(ReadTrajectory, TumQuaternionsHaveTheirScalarLast)
{
  const auto file = folder.write("poses.txt", "# stamp tx ty tz qx qy qz qw\n12.5 1 2 3 0 0 1 0\n");
  const Trajectory read = readTrajectory(file);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].stamp, 12.5);
  EXPECT_LT((read[0].world_T_sensor.rotation * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST_F(ReadTrajectory, RotationsOfFewDigitsBecomeProperOnes)
{
  const auto file = folder.write("poses.txt", "0.7071 -0.7071 0 0 0.7071 0.7071 0 0 0 0 1 0\n");
  const Eigen::Matrix3d rotation = readTrajectory(file)[0].world_T_sensor.rotation;
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST_F(ReadTrajectory, ErrorsNameLineAndReason)
{
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {good + "1 0 0 0 0 1 0 0 0 0 1\n", "line 2: 11 columns"},
      {good + "\n1 0 0 0 0 1 0 0 0 0 one 0\n", "line 3: 'one'"},
      {good + "1 0 0 nan 0 1 0 0 0 0 1 0\n", "line 2: 'nan'"},
      {good + "2 0 0 0 0 1 0 0 0 0 1 0\n", "line 2: the left 3x3 numbers are no rotation"},
      {good + "1 0 0 0 0 1 0 0 0 0 -1 0\n", "line 2: the left 3x3 numbers are no rotation"},
      {"0 0 0 0 0 0 0 0\n", "line 1: the quaternion's length is not 1"},
      {"0 0 0 0 0 0 0 1\n" + good, "line 2: 12 columns instead of 8 (TUM)"},
      {"1 2 3\n", "line 1: 3 columns"},
      {"# nothing\n\n", "has no pose"},
      {"", "has no pose"}};
  for (const auto& [content, reason] : cases) {
    const std::string message = reasonOfTrajectory(folder.write("poses.txt", content));
    EXPECT_NE(message.find(reason), std::string::npos) << message << " lacks " << reason;
  }
  EXPECT_NE(reasonOfTrajectory(folder.path() / "missing.txt").find("cannot be read"), std::string::npos);
  EXPECT_NE(reasonOfTrajectory(folder.path()).find("is a folder"), std::string::npos);
}

TEST_F(ReadTrajectory, ANamedFormatIsNotGuessed)
{
  const auto file = folder.write("poses.txt", "0 0 0 0 0 0 0 1\n");
  EXPECT_NE(reasonOfTrajectory(file, TrajectoryFormat::kitti).find("instead of 12 (KITTI)"), std::string::npos);
  EXPECT_EQ(reasonOfTrajectory(file, TrajectoryFormat::tum), "");
}

}  // namespace
}  // namespace pcl_floam
