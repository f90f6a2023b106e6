// Runs of the odometry tool that end before their scans do.
#include "tools/odometry_tool_fixture.h"

#include <pcl_floam/io/map_io.h>

#include <chrono>
#include <csignal>
#include <thread>

#include <unistd.h>

namespace pcl_floam {
namespace {

using test::contentOf;

class InterruptedRun : public test::OdometryTool {
protected:
  static constexpr std::size_t kManyScans = 400;

  InterruptedRun()
  {
    for (std::size_t i = kScans; i < kManyScans; ++i) {
      std::filesystem::create_symlink("0.bin", folder.path() / "scans" / (std::to_string(i) + ".bin"));
    }
  }

  /// Sends a signal once the third pose is written. \return the status that waitpid gives
  [[nodiscard]] int interruptBy(int signal) const
  {
    const pid_t tool = fork();
    if (tool == 0) {
      if (chdir(folder.path().c_str()) != 0) {
        _exit(98);
      }
      execl(PCL_FLOAM_ODOMETRY, "pcl_floam_odometry", "scans", "-o", "result", "--plot", "none", "-q", nullptr);
      _exit(99);
    }
    for (int wait = 0; wait < 3000 && lines("poses.kitti.txt") < 3; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    kill(tool, signal);
    int status = 0;
    waitpid(tool, &status, 0);
    return status;
  }

  void expectSomePoses() const
  {
    EXPECT_GE(poses().size(), 3U);
    EXPECT_LT(poses().size(), kManyScans);
  }
};

TEST_F(InterruptedRun, EndsAfterThePresentScanWithEverythingWritten)
{
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(folder.path() / "result");
    const int status = interruptBy(signal);
    ASSERT_TRUE(WIFEXITED(status)) << status;
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    expectSomePoses();
    EXPECT_EQ(poses().size(), summary()["scans"]["processed"]);
    EXPECT_EQ(lines("timing.csv"), lines("poses.kitti.txt") + 1);
    EXPECT_EQ(lines("scans.csv"), lines("poses.kitti.txt") + 1);
    EXPECT_EQ(lines("poses.tum.txt"), lines("poses.kitti.txt"));
    EXPECT_FALSE(loadMap(folder.path() / "result").empty());
  }
}

TEST_F(InterruptedRun, KilledItLeavesWholeLinesUpToTheLastScan)
{
  const int status = interruptBy(SIGKILL);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  expectSomePoses();
  const Trajectory tum = readTrajectory(folder.path() / "result" / "poses.tum.txt", TrajectoryFormat::tum);
  EXPECT_LE(poses().size() - tum.size(), 1U);
  const std::string timing = contentOf(folder.path() / "result" / "timing.csv");
  EXPECT_EQ(timing.back(), '\n');
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "result" / kMapEdgesFile));
}

}  // namespace
}  // namespace pcl_floam
