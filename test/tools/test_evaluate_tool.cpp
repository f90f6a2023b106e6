// pcl_floam_evaluate, run as a user does on what the odometry wrote.

#include "tools/odometry_tool_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::OdometryTool;
using test::Outcome;

TEST_F(OdometryTool, EvaluateAgreesWithTheOdometrysOwnFigures)
{
  ASSERT_EQ(odometry("scans -o result --ground-truth truth.txt --plot none").status, 0);
  const Outcome outcome = evaluate("--estimate result/poses.kitti.txt --ground-truth truth.txt --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto figures = nlohmann::json::parse(outcome.out);
  const auto own = summary()["accuracy"];
  EXPECT_NEAR(figures["ate"]["position_m"]["rms"].get<double>(), own["ate"]["position_m"]["rms"].get<double>(), 1e-6);
  EXPECT_NEAR(figures["kitti"]["t_rel_percent"].get<double>(), own["kitti"]["t_rel_percent"].get<double>(), 1e-4);
  EXPECT_FALSE(figures["kitti"]["standard_lengths"].get<bool>());
}

TEST_F(OdometryTool, EvaluateWritesTextAndJson)
{
  const Outcome outcome = evaluate("--estimate truth.txt --ground-truth truth.txt --lengths 1,2 -o evaluation");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("t_rel 0.000 %"), std::string::npos) << outcome.out;
  EXPECT_EQ(contentOf(folder.path() / "evaluation" / "evaluation.txt"), outcome.out);
  const auto json = nlohmann::json::parse(contentOf(folder.path() / "evaluation" / "evaluation.json"));
  EXPECT_EQ(json["kitti"]["lengths"].size(), 2U);
}

TEST_F(OdometryTool, EvaluateRefusesWhatItCannotCompare)
{
  folder.write("short.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  for (const char* arguments :
       {"--estimate truth.txt", "--estimate truth.txt --ground-truth nowhere.txt",
        "--estimate truth.txt --ground-truth short.txt", "--estimate truth.txt --ground-truth truth.txt --format tum",
        "--estimate truth.txt --ground-truth truth.txt --lengths -5",
        "--estimate truth.txt --ground-truth truth.txt --align scale"}) {
    const Outcome outcome = evaluate(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << ": " << outcome.err;
  }
}

}  // namespace
}  // namespace pcl_floam
