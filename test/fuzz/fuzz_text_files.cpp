// Trajectories and times from files of any bytes.
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_targets.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <cmath>

namespace pcl_floam::test {

namespace {

void checkPoses(const Trajectory& trajectory)
{
  mustHold(!trajectory.empty(), "a trajectory without poses was accepted");
  for (const StampedPose& pose : trajectory) {
    const Eigen::Matrix3d& r = pose.world_T_sensor.rotation;
    mustHold(std::isfinite(pose.stamp) && pose.world_T_sensor.isFinite(), "a pose is not finite");
    mustHold((r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9 && r.determinant() > 0.0,
             "a pose has no proper rotation");
  }
}

void checkItReadsBack(const TemporaryFolder& folder, const Trajectory& trajectory, TrajectoryFormat format)
{
  const std::filesystem::path file = folder.path() / "again.txt";
  {
    TrajectoryWriter writer(file, format);
    for (const StampedPose& pose : trajectory) {
      writer.write(pose);
    }
  }
  const Trajectory again = readTrajectory(file);
  mustHold(again.size() == trajectory.size(), "a written trajectory reads back with another length");
  for (std::size_t i = 0; i < again.size(); ++i) {
    const Eigen::Vector3d& t = trajectory[i].world_T_sensor.translation;
    const Eigen::Vector3d difference = again[i].world_T_sensor.translation - t;
    mustHold(difference.cwiseAbs().maxCoeff() <= 1e-8 * (1.0 + t.cwiseAbs().maxCoeff()),
             "a written pose reads back elsewhere");
  }
}

}  // namespace

void fuzzPoses(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  const std::filesystem::path file = writeInput(folder, "poses.txt", bytes, size);
  for (const TrajectoryFormat format : {TrajectoryFormat::automatic, TrajectoryFormat::kitti, TrajectoryFormat::tum}) {
    Trajectory trajectory;
    try {
      trajectory = readTrajectory(file, format);
    } catch (const FileError&) {
      continue;
    }
    checkPoses(trajectory);
    checkItReadsBack(folder, trajectory, format == TrajectoryFormat::automatic ? TrajectoryFormat::kitti : format);
  }
}

void fuzzTimes(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  for (const char* scan : {"0.bin", "1.bin", "2.bin"}) {
    if (!std::filesystem::exists(folder.path() / scan)) {
      folder.write(scan, std::string(16, '\0'));
    }
  }
  writeInput(folder, "times.txt", bytes, size);
  try {
    const ScanSource scans(folder.path());
    mustHold(scans.size() == 3, "the times changed the number of scans");
    for (std::size_t i = 0; i < scans.size(); ++i) {
      mustHold(std::isfinite(scans.stamp(i).value()), "a time is not finite");
    }
  } catch (const FileError&) {
  }
}

}  // namespace pcl_floam::test
