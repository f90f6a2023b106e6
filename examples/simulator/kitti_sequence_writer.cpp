#include "kitti_sequence_writer.h"

#include "dataset_writer.h"

#include <cstdio>
#include <iomanip>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

/// A camera looks along its z, with x to the right and y down; it stands a little before and below the lidar.
SE3 cameraTLidar()
{
  Eigen::Matrix3d rotation;
  rotation << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  return {rotation, Eigen::Vector3d(-0.01, -0.07, -0.28)};
}

void writeRow(std::ofstream& stream, const SE3& pose)
{
  const Eigen::Matrix4d matrix = pose.matrix();
  for (Eigen::Index i = 0; i < 12; ++i) {
    stream << (i > 0 ? " " : "") << matrix(i / 4, i % 4);
  }
  stream << std::endl;
}

std::ofstream createText(const std::filesystem::path& file)
{
  std::ofstream stream(file);
  if (!stream) {
    throw std::runtime_error(file.string() + ": cannot be created");
  }
  stream << std::setprecision(12);
  return stream;
}

}  // namespace

Sweep compensatedAtMiddle(const Simulation& simulation, const Sweep& sweep)
{
  Sweep result = sweep;
  const SE3 middle_T_world = sweep.world_T_middle.inverse();
  for (PointXYZIRT& point : result.cloud) {
    const SE3 middle_T_sensor =
        middle_T_world * simulation.worldTSensor(sweep.start_time + static_cast<double>(point.time));
    point.getVector3fMap() = (middle_T_sensor * point.getVector3fMap().cast<double>()).cast<float>();
  }
  return result;
}

KittiSequenceWriter::KittiSequenceWriter(const std::filesystem::path& root, const std::string& sequence)
    : scans_(root / "sequences" / sequence / "velodyne")
{
  std::error_code error;
  std::filesystem::create_directories(scans_, error);
  std::filesystem::create_directories(root / "poses", error);
  if (error || !std::filesystem::is_empty(scans_)) {
    throw std::runtime_error(scans_.string() + (error ? ": cannot be created" : ": holds files already"));
  }
  times_ = createText(scans_.parent_path() / "times.txt");
  poses_ = createText(root / "poses" / (sequence + ".txt"));
  std::ofstream calibration = createText(scans_.parent_path() / "calib.txt");
  calibration << "Tr: ";
  writeRow(calibration, cameraTLidar());
}

void KittiSequenceWriter::write(const Simulation& simulation, const Sweep& sweep)
{
  char name[16];
  std::snprintf(name, sizeof(name), "%06zu.bin", sweep.number);
  writeKittiBin(scans_ / name, compensatedAtMiddle(simulation, sweep));
  if (!begun_) {
    first_T_world_ = sweep.world_T_middle.inverse();
    begun_ = true;
  }
  times_ << sweep.start_time << std::endl;
  writeRow(poses_, cameraTLidar() * first_T_world_ * sweep.world_T_middle * cameraTLidar().inverse());
  if (!times_ || !poses_) {
    throw std::runtime_error(scans_.parent_path().string() + ": cannot be written");
  }
}

}  // namespace pcl_floam::simulator
