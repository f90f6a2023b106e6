#include "result_writer.h"

#include "stage_times.h"

#include <pcl_floam/io/scan_source.h>

#include <iomanip>
#include <locale>
#include <system_error>

namespace pcl_floam::tools {

namespace {

constexpr const char* kKittiName = "poses.kitti.txt";
constexpr const char* kTumName = "poses.tum.txt";

const std::filesystem::path& created(const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error)) {
    throw FileError(folder, "cannot be made a folder" + (error ? ": " + error.message() : std::string()));
  }
  return folder;
}

}  // namespace

ResultWriter::ResultWriter(const std::filesystem::path& folder)
    : folder_(created(folder)),
      kitti_(folder_ / kKittiName, TrajectoryFormat::kitti),
      tum_(folder_ / kTumName, TrajectoryFormat::tum),
      timing_path_(folder / "timing.csv"),
      timing_(timing_path_)
{
  timing_.imbue(std::locale::classic());
  timing_ << "scan";
  for (const Stage& stage : kStages) {
    timing_ << ',' << stage.name << "_ms";
  }
  errno = 0;
  timing_ << '\n' << std::fixed << std::setprecision(3) << std::flush;
  if (!timing_) {
    throw FileError::ofSystem(timing_path_, "cannot be written");
  }
}

void ResultWriter::write(std::size_t scan, double stamp, const OdometryReport& report)
{
  if (!report.corrected_poses.empty()) {
    correctLast(report.corrected_poses);
  }
  written_.push_back({stamp, report.world_T_sensor});
  kitti_.write(written_.back());
  tum_.write(written_.back());
  timing_ << scan;
  for (const Stage& stage : kStages) {
    timing_ << ',' << report.milliseconds.*stage.time;
  }
  errno = 0;
  timing_ << '\n' << std::flush;
  if (!timing_) {
    throw FileError::ofSystem(timing_path_, "cannot be written");
  }
}

void ResultWriter::correctLast(const std::vector<SE3>& poses)
{
  auto last = written_.end() - static_cast<std::ptrdiff_t>(poses.size());
  for (const SE3& pose : poses) {
    (last++)->world_T_sensor = pose;
  }
  kitti_ = TrajectoryWriter(folder_ / kKittiName, TrajectoryFormat::kitti);
  tum_ = TrajectoryWriter(folder_ / kTumName, TrajectoryFormat::tum);
  for (const StampedPose& pose : written_) {
    kitti_.write(pose);
    tum_.write(pose);
  }
}

void writeTextFile(const std::filesystem::path& file, const std::string& text)
{
  errno = 0;
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) {
    throw FileError::ofSystem(file, "cannot be written");
  }
}

}  // namespace pcl_floam::tools
