// What pcl_floam_evaluate tells of a trajectory without ground truth.
#include "tools/odometry_tool_fixture.h"

#include <cmath>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::Outcome;

class EvaluationWithoutTruth : public test::OdometryTool {
protected:
  /// The fixture's true poses, every second one off to the side.
  /// \param offset m \param poses as many \param first_stamp s; not negative: as TUM's, with times 0.1 s apart
  [[nodiscard]] static std::string trajectory(double offset, std::size_t poses = kScans, double first_stamp = -1.0)
  {
    std::string text;
    for (std::size_t i = 0; i < poses; ++i) {
      const std::string x = std::to_string(kStep * static_cast<double>(i));
      const std::string y = std::to_string(i % 2 == 1 ? offset : 0.0);
      const std::string stamp = std::to_string(first_stamp + 0.1 * static_cast<double>(i));
      text +=
          first_stamp < 0.0 ? "1 0 0 " + x + " 0 1 0 " + y + " 0 0 1 0\n" : stamp + " " + x + " " + y + " 0 0 0 0 1\n";
    }
    return text;
  }

  [[nodiscard]] nlohmann::json figures(const std::string& arguments) const
  {
    const Outcome outcome = evaluate(arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(EvaluationWithoutTruth, ThePosesOfTheDriveMakeASharperMapThanOthers)
{
  folder.write("other.txt", trajectory(0.1));
  const auto own = figures("--estimate truth.txt --scans scans");
  const auto other = figures("--estimate other.txt --scans scans");
  EXPECT_LT(own["sharpness"]["mean_map_entropy"].get<double>(),
            other["sharpness"]["mean_map_entropy"].get<double>() - 0.1);
  EXPECT_LT(own["sharpness"]["spread_across_planes_m"].get<double>(),
            0.9 * other["sharpness"]["spread_across_planes_m"].get<double>());
  const double spread = own["sharpness"]["spread_across_planes_m"].get<double>();
  EXPECT_NEAR(own["sharpness"]["mean_plane_variance_m2"].get<double>(), spread * spread, 1e-12);
  EXPECT_GT(own["sharpness"]["points"], 5000);
  EXPECT_EQ(own["sharpness"]["scans"], kScans);
  EXPECT_EQ(own["poses"], kScans);
  EXPECT_FALSE(own.contains("ate"));
  EXPECT_FALSE(own.contains("rest"));
}

TEST_F(EvaluationWithoutTruth, JudgesWhatTheOdometrySaved)
{
  ASSERT_EQ(odometry("scans -o result --timing none --plot none --save-scans saved").status, 0);
  folder.write("other.txt", trajectory(0.05));
  const auto spread = [this](const std::string& estimate, const std::string& scans) {
    const auto sharpness = figures("--estimate " + estimate + " --scans " + scans)["sharpness"];
    return sharpness["spread_across_planes_m"].get<double>();
  };
  const double own = spread("result/poses.kitti.txt", "saved");
  EXPECT_NEAR(own, spread("truth.txt", "scans"), 0.002);
  EXPECT_LT(own, spread("other.txt", "saved") - 0.002);
}

TEST_F(EvaluationWithoutTruth, TheRadiusIsThatOfTheNeighbourhoods)
{
  const auto narrow = figures("--estimate truth.txt --scans scans --radius 0.2")["sharpness"];
  const auto wide = figures("--estimate truth.txt --scans scans --radius 0.6")["sharpness"];
  EXPECT_EQ(narrow["radius_m"], 0.2);
  EXPECT_GT(wide["mean_map_entropy"].get<double>(), narrow["mean_map_entropy"].get<double>() + 0.5);
}

TEST_F(EvaluationWithoutTruth, ScansOfWhichSomeHaveNoPoseAreFoundByTheirTimes)
{
  std::string times;
  for (std::size_t i = 0; i < kScans; ++i) {
    times += std::to_string(100.0 + 0.1 * static_cast<double>(i)) + "\n";
  }
  folder.write("times.txt", times);
  // From the third scan's time on, with poses of that scan's place on.
  folder.write("late.txt", trajectory(0.0, kScans - 2, 100.2));
  const auto sharpness = figures("--estimate late.txt --scans scans")["sharpness"];
  EXPECT_EQ(sharpness["scans"], kScans - 2);
  const auto all = figures("--estimate truth.txt --scans scans")["sharpness"];
  EXPECT_NEAR(sharpness["mean_map_entropy"].get<double>(), all["mean_map_entropy"].get<double>(), 0.2);
}

TEST_F(EvaluationWithoutTruth, PlacesThatOneScanSawAreNoFigure)
{
  folder.write("apart/0.bin", contentOf(folder.path() / "scans/0.bin"));
  folder.write("apart/1.bin", contentOf(folder.path() / "scans/1.bin"));
  folder.write("apart.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 900 0 1 0 0 0 0 1 0\n");
  const auto sharpness = figures("--estimate apart.txt --scans apart")["sharpness"];
  EXPECT_EQ(sharpness["points"], 0);
  EXPECT_TRUE(sharpness["mean_map_entropy"].is_null());
  EXPECT_NE(evaluate("--estimate apart.txt --scans apart").out.find("no place was seen by two of 2 scans"),
            std::string::npos);
}

TEST_F(EvaluationWithoutTruth, AtRestTellsHowFarItWanders)
{
  folder.write("rest.txt", "1 0 0 5 0 1 0 0 0 0 1 0\n1 0 0 5.03 0 1 0 0.04 0 0 1 0\n0 -1 0 5 1 0 0 0.01 0 0 1 0\n");
  const auto rest = figures("--estimate rest.txt --at-rest")["rest"];
  EXPECT_NEAR(rest["wander_m"].get<double>(), 0.05, 1e-9);
  EXPECT_NEAR(rest["drift_m"].get<double>(), 0.01, 1e-9);
  EXPECT_NEAR(rest["jitter_max_m"].get<double>(), 0.05, 1e-9);
  EXPECT_NEAR(rest["jitter_rms_m"].get<double>(), std::sqrt((25.0 + 18.0) / 2.0) / 100.0, 1e-9);
  EXPECT_NEAR(rest["wander_deg"].get<double>(), 90.0, 1e-9);
  EXPECT_NEAR(rest["drift_deg"].get<double>(), 90.0, 1e-9);
  EXPECT_NEAR(rest["jitter_max_deg"].get<double>(), 90.0, 1e-9);
  EXPECT_NEAR(rest["jitter_rms_deg"].get<double>(), 90.0 / std::sqrt(2.0), 1e-9);
  const std::string text = evaluate("--estimate rest.txt --at-rest").out;
  EXPECT_NE(text.find("wander 0.0500   drift 0.0100"), std::string::npos) << text;
}

TEST_F(EvaluationWithoutTruth, AllIsToldAndWrittenTogether)
{
  const Outcome outcome =
      evaluate("--estimate truth.txt --ground-truth truth.txt --scans scans --at-rest -o evaluation");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"ATE", "mean map entropy", "wander 2.1000"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(contentOf(folder.path() / "evaluation" / "evaluation.txt"), outcome.out);
  const auto json = nlohmann::json::parse(contentOf(folder.path() / "evaluation" / "evaluation.json"));
  for (const char* key : {"kitti", "ate", "sharpness", "rest"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST_F(EvaluationWithoutTruth, DrawsThePathWithoutTruth)
{
  const Outcome outcome = evaluate("--estimate truth.txt --at-rest -o evaluation");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const bool told = outcome.err.find("gnuplot is not installed") != std::string::npos;
  EXPECT_NE(told, contentOf(folder.path() / "evaluation" / "evaluation.svg").find("</svg>") != std::string::npos);
}

TEST_F(EvaluationWithoutTruth, RefusesInOneLineWhatItCannotJudge)
{
  folder.write("short.txt", trajectory(0.0, 3));
  folder.write("late.txt", trajectory(0.0, 3, 500.0));
  folder.write("damaged/0.bin", "not a scan");
  folder.write("one.txt", trajectory(0.0, 1));
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--estimate truth.txt", "one of --ground-truth, --scans and --at-rest is required"},
      {"--at-rest", "--estimate is required"},
      {"--estimate nowhere.txt --at-rest", "nowhere.txt: cannot be read"},
      {"--estimate truth.txt --scans nowhere", "nowhere: no such f"},
      {"--estimate short.txt --scans scans", "has 8 scans for 3 poses, and not both have times"},
      {"--estimate late.txt --scans scans", "has 8 scans for 3 poses, and not both have times"},
      {"--estimate one.txt --scans damaged", "0.bin: byte 10"},
      {"--estimate truth.txt --scans scans --radius 0", "--radius"},
      {"--estimate truth.txt --at-rest --radius 1", "--scans"},
      {"--estimate truth.txt --at-rest --calibration calib.txt", "--ground-truth"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = evaluate(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << arguments << ": " << outcome.err;
  }
  folder.write("times.txt", "0\n1\n2\n3\n4\n5\n6\n7\n");
  EXPECT_NE(evaluate("--estimate late.txt --scans scans").err.find("fewer than two scans have a pose"),
            std::string::npos);
}

}  // namespace
}  // namespace pcl_floam
