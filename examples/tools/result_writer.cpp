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

std::string timingColumns()
{
  std::string columns = "scan";
  for (const Stage& stage : kStages) {
    columns += std::string(",") + stage.name + "_ms";
  }
  return columns;
}

constexpr const char* kScanColumns =
    "scan,state,provisional,explained,scan_only_deviation_m,weak_directions,covariance_xx_m2,covariance_xy_m2,"
    "covariance_xz_m2,covariance_yy_m2,covariance_yz_m2,covariance_zz_m2,reason";

/// As CSV has it: quotation marks within are doubled.
std::string quoted(const std::string& text)
{
  std::string result = "\"";
  for (const char c : text) {
    result += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return result + '"';
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& path, const std::string& columns) : path_(path), stream_(path)
{
  stream_.imbue(std::locale::classic());
  stream_ << columns;
  endRow();
}

void CsvFile::endRow()
{
  errno = 0;
  stream_ << '\n' << std::flush;
  if (!stream_) {
    throw FileError::ofSystem(path_, "cannot be written");
  }
}

ResultWriter::ResultWriter(const std::filesystem::path& folder)
    : kitti_(created(folder) / "poses.kitti.txt", TrajectoryFormat::kitti),
      tum_(folder / "poses.tum.txt", TrajectoryFormat::tum),
      timing_(folder / "timing.csv", timingColumns()),
      scans_(folder / "scans.csv", kScanColumns)
{
  timing_.row() << std::fixed << std::setprecision(3);
  scans_.row() << std::setprecision(9);
}

void ResultWriter::write(std::size_t scan, double stamp, const OdometryReport& report)
{
  writePoses({stamp, report.world_T_sensor}, report.corrected_poses);
  writeStageTimes(scan, report.milliseconds);
  writeVerdict(scan, report);
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

void ResultWriter::writeStageTimes(std::size_t scan, const StageTimes& times)
{
  timing_.row() << scan;
  for (const Stage& stage : kStages) {
    timing_.row() << ',' << times.*stage.time;
  }
  timing_.endRow();
}

void ResultWriter::writeVerdict(std::size_t scan, const OdometryReport& report)
{
  scans_.row() << scan << ',' << toString(report.state) << ',' << (report.provisional ? 1 : 0) << ','
               << report.explained << ',' << report.scan_only_deviation << ','
               << report.registration.weak_directions.size();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = i; k < 3; ++k) {
      scans_.row() << ',' << report.covariance(i, k);
    }
  }
  scans_.row() << ',' << quoted(report.reason);
  scans_.endRow();
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
