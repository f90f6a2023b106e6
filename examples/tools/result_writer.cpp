#include "result_writer.h"

#include "stage_times.h"

#include <pcl_floam/io/scan_source.h>

#include <iomanip>
#include <locale>
#include <sstream>
#include <system_error>

namespace pcl_floam::tools {

namespace {

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
    : kitti_(created(folder) / "poses.kitti.txt", TrajectoryFormat::kitti),
      tum_(folder / "poses.tum.txt", TrajectoryFormat::tum),
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
  writePoses({stamp, report.world_T_sensor}, report.corrected_poses);
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

void ResultWriter::writePoses(const StampedPose& pose, const std::vector<SE3>& corrected)
{
  auto last = written_.end() - static_cast<std::ptrdiff_t>(corrected.size());
  for (const SE3& world_T_sensor : corrected) {
    (last++)->world_T_sensor = world_T_sensor;
  }
  written_.push_back(pose);
  for (TrajectoryWriter* writer : {&kitti_, &tum_}) {
    corrected.empty() ? writer->write(pose) : writer->writeAgain(written_);
  }
}

void writeTimes(const std::vector<double>& times, const std::filesystem::path& file)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(9);
  for (const double time : times) {
    text << time << '\n';
  }
  writeTextFile(file, text.str());
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
