/// \file odometry_tool_fixture.h
/// The tools, run as a user runs them.
#pragma once

#include "support/room_scans.h"
#include "support/temporary_folder.h"

#include <pcl_floam/io/trajectory.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <sys/wait.h>

namespace pcl_floam::test {

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// A scene with scans along a straight drive, and tools run on it.
class OdometryTool : public ::testing::Test {
protected:
  static constexpr std::size_t kScans = 8;
  static constexpr double kStep = 0.3;  // m from scan to scan

  OdometryTool()
  {
    std::string truth;
    for (std::size_t i = 0; i < kScans; ++i) {
      const double x = kStep * static_cast<double>(i);
      folder.write("scans/" + std::to_string(i) + ".bin", test::roomScan(x, 0.0));
      truth += "1 0 0 " + std::to_string(x) + " 0 1 0 0 0 0 1 0\n";
    }
    folder.write("truth.txt", truth);
  }

  /// \param arguments for the shell; the present folder is the test's
  [[nodiscard]] Outcome run(const std::string& tool, const std::string& arguments) const
  {
    const std::string command = "cd '" + folder.path().string() + "' && '" + tool + "' " + arguments + " >out 2>err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(folder.path() / "out"),
            contentOf(folder.path() / "err")};
  }
  [[nodiscard]] Outcome odometry(const std::string& arguments) const { return run(PCL_FLOAM_ODOMETRY, arguments); }
  [[nodiscard]] Outcome evaluate(const std::string& arguments) const { return run(PCL_FLOAM_EVALUATE, arguments); }

  [[nodiscard]] Trajectory poses() const { return readTrajectory(folder.path() / "result" / "poses.kitti.txt"); }
  [[nodiscard]] nlohmann::json summary() const
  {
    return nlohmann::json::parse(contentOf(folder.path() / "result" / "summary.json"));
  }
  [[nodiscard]] std::ptrdiff_t lines(const std::string& file) const
  {
    const std::string content = contentOf(folder.path() / "result" / file);
    return std::count(content.begin(), content.end(), '\n');
  }

  /// Every scan has a true pose, and its own is near that.
  void expectAllJudgedBy(const std::string& truth) const
  {
    const Outcome outcome = odometry("scans -o result --ground-truth " + truth + " --plot none");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(summary()["accuracy"]["poses"], kScans);
    EXPECT_LT(summary()["accuracy"]["ate"]["position_m"]["max"].get<double>(), 0.05);
  }

  TemporaryFolder folder;
};

}  // namespace pcl_floam::test
