#include "scan_saver.h"

#include "result_writer.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/core/sweep_motion.h>
#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/scan_writer.h>

#include <algorithm>
#include <cstring>
#include <system_error>
#include <utility>

namespace pcl_floam::tools {

void undistort(pcl::PCLPointCloud2& cloud, const OdometryReport& report, const OdometryParameters& parameters,
               const SE3& frame_T_sensor)
{
  const CloudView view = viewOf(cloud);
  const SweepMotion motion(report.registration.sweep_twist, fractionOf(PoseInstant::middle),
                           report.registration.sweep_acceleration);
  if (motion.isStill() || parameters.compensation == CompensationMode::none) {
    return;
  }
  MovedCloud moved_cloud;
  const CloudView seen = moved_cloud.take(view, frame_T_sensor.inverse());
  ScanLines lines;
  ScanTiming timing = findScanTiming(seen, lines, report.timing_source);
  if (!timing.valid() && report.timing_source != ScanTimingSource::none) {
    findScanLines(seen, parameters.sensor, ScanLineSource::automatic, lines);
    timing = findScanTiming(seen, lines, report.timing_source);
  }
  if (!timing.valid()) {
    return;
  }
  const SE3 reference_T_middle = motion.at(fractionOf(parameters.pose_instant)).inverse();
  std::vector<float> moved(3 * view.size);  // the view reads what is written below
  for (std::size_t i = 0; i < view.size; ++i) {
    const Eigen::Vector3d point(view.x(i), view.y(i), view.z(i));
    const Eigen::Vector3f there = ((reference_T_middle * motion.at(timing.at(seen, i))) * point).cast<float>();
    std::memcpy(&moved[3 * i], there.data(), 3 * sizeof(float));
  }
  for (std::size_t i = 0; i < view.size; ++i) {
    std::uint8_t* point = cloud.data.data() + i * cloud.point_step;
    const float* there = &moved[3 * i];
    std::memcpy(point + view.x_offset, there, sizeof(float));
    std::memcpy(point + view.y_offset, there + 1, sizeof(float));
    std::memcpy(point + view.z_offset, there + 2, sizeof(float));
  }
  const auto isTime = [](const pcl::PCLPointField& field) { return isTimeField(field.name); };
  cloud.fields.erase(std::remove_if(cloud.fields.begin(), cloud.fields.end(), isTime), cloud.fields.end());
}

void prepareScanFolder(const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw FileError(folder, "cannot be created: " + error.message());
  }
  if (!std::filesystem::is_empty(folder, error)) {
    throw FileError(
        folder, error ? "cannot be listed: " + error.message() : "is not empty: the scans need a folder of their own");
  }
}

ScanSaver::ScanSaver(std::filesystem::path folder, const SE3& frame_T_sensor)
    : folder_(std::move(folder)), frame_T_sensor_(frame_T_sensor)
{
  if (!folder_.empty()) {
    prepareScanFolder(folder_);
  }
}

void ScanSaver::save(std::size_t scan, double time, pcl::PCLPointCloud2& cloud, const OdometryReport& report,
                     const OdometryParameters& parameters)
{
  if (folder_.empty()) {
    return;
  }
  times_.push_back(time);
  correct(scan, report);
  waiting_.push_back({scan, cloud, report, parameters});
  constexpr std::size_t kMostWaiting = 200;  // a start may take long to be told
  const bool is_known = !report.provisional && report.state != TrackingState::initialized;
  if (is_known || waiting_.size() == kMostWaiting) {
    writeWaiting();
  }
}

/// What is known by now of the scans that wait: poses, how the sensor moved between them, and their points' times.
void ScanSaver::correct(std::size_t scan, const OdometryReport& report)
{
  const std::vector<SE3>& poses = report.corrected_poses;
  const auto poseOf = [&](std::size_t number) {
    return number < scan ? poses[poses.size() - (scan - number)] : report.world_T_sensor;
  };
  for (Waiting& one : waiting_) {
    one.report.timing_source = report.timing_source;
    if (scan - one.scan <= poses.size()) {
      one.report.world_T_sensor = poseOf(one.scan);
      one.report.registration.sweep_twist = log(poseOf(one.scan).inverse() * poseOf(one.scan + 1));
      one.report.registration.sweep_acceleration = Vector6::Zero();
    }
  }
}

void ScanSaver::writeWaiting()
{
  for (Waiting& one : waiting_) {
    undistort(one.cloud, one.report, one.parameters, frame_T_sensor_);
    writePcd(one.cloud, folder_ / numberedName(one.scan));
  }
  waiting_.clear();
}

void ScanSaver::finish()
{
  if (!folder_.empty()) {
    writeWaiting();
    writeTimes(times_, folder_ / "times.txt");
  }
}

std::string numberedName(std::size_t number)
{
  constexpr std::size_t kDigits = 6;
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < kDigits ? kDigits - digits.size() : 0, '0') + digits + ".pcd";
}

}  // namespace pcl_floam::tools
