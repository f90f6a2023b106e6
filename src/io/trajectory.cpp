#include "io/text.h"
#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <cmath>
#include <Eigen/LU>
#include <iomanip>
#include <locale>
#include <string>
#include <system_error>
#include <utility>

namespace pcl_floam {

namespace {

constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kTumColumns = 8;

/// Rotations may be off by what a few printed digits cost; more means that they are something else.
constexpr double kRotationTolerance = 1e-2;

using Numbers = std::vector<double>;

/// The numbers of a line, or what is wrong with it in \p problem.
Numbers parseNumbers(const std::vector<std::string_view>& words, std::string& problem)
{
  Numbers numbers;
  for (const std::string_view word : words) {
    const auto number = parseNumber<double>(word);
    if (!number || !std::isfinite(*number)) {
      problem = "'" + std::string(word.substr(0, 40)) + "' is no finite number";
      return {};
    }
    numbers.push_back(*number);
  }
  return numbers;
}

StampedPose kittiPose(const Numbers& n, double stamp, std::string& problem)
{
  Eigen::Matrix3d rotation;
  rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const double bent = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(bent < kRotationTolerance) || rotation.determinant() < 0.0) {
    problem = "the left 3x3 numbers are no rotation";
    return {};
  }
  return {stamp, SE3(nearestRotation(rotation), Eigen::Vector3d(n[3], n[7], n[11]))};
}

StampedPose tumPose(const Numbers& n, std::string& problem)
{
  Eigen::Quaterniond quaternion(n[7], n[4], n[5], n[6]);
  if (!(std::abs(quaternion.norm() - 1.0) < kRotationTolerance)) {
    problem = "the quaternion's length is not 1";
    return {};
  }
  quaternion.normalize();
  return {n[0], SE3(quaternion.toRotationMatrix(), Eigen::Vector3d(n[1], n[2], n[3]))};
}

TrajectoryFormat formatOf(std::size_t columns)
{
  if (columns == kKittiColumns) {
    return TrajectoryFormat::kitti;
  }
  return columns == kTumColumns ? TrajectoryFormat::tum : TrajectoryFormat::automatic;
}

std::string columnsProblem(std::size_t columns, TrajectoryFormat format)
{
  const std::string expected = format == TrajectoryFormat::kitti ? "12 (KITTI)"
                               : format == TrajectoryFormat::tum ? "8 (TUM)"
                                                                 : "12 (KITTI) or 8 (TUM)";
  return std::to_string(columns) + " columns instead of " + expected;
}

StampedPose parsePose(const std::vector<std::string_view>& words, TrajectoryFormat format, std::size_t index,
                      std::string& problem)
{
  if (formatOf(words.size()) != format) {
    problem = columnsProblem(words.size(), format);
    return {};
  }
  const Numbers numbers = parseNumbers(words, problem);
  if (!problem.empty()) {
    return {};
  }
  return format == TrajectoryFormat::kitti ? kittiPose(numbers, static_cast<double>(index), problem)
                                           : tumPose(numbers, problem);
}

}  // namespace

TrajectoryFormat trajectoryFormat(const std::filesystem::path& file)
{
  const std::string content = readWholeFile(file);
  std::string_view rest = content;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const auto words = splitWords(takeLine(rest));
    if (words.empty() || words.front().front() == '#') {
      continue;
    }
    const TrajectoryFormat format = formatOf(words.size());
    if (format == TrajectoryFormat::automatic) {
      throw FileError(file, "line " + std::to_string(line) + ": " + columnsProblem(words.size(), format));
    }
    return format;
  }
  throw FileError(file, "has no pose");
}

Trajectory readTrajectory(const std::filesystem::path& file, TrajectoryFormat format)
{
  if (format == TrajectoryFormat::automatic) {
    format = trajectoryFormat(file);
  }
  const std::string content = readWholeFile(file);
  Trajectory trajectory;
  std::string_view rest = content;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const auto words = splitWords(takeLine(rest));
    if (words.empty() || words.front().front() == '#') {
      continue;
    }
    std::string problem;
    trajectory.push_back(parsePose(words, format, trajectory.size(), problem));
    if (!problem.empty()) {
      throw FileError(file, "line " + std::to_string(line) + ": " + problem);
    }
  }
  if (trajectory.empty()) {
    throw FileError(file, "has no pose");
  }
  return trajectory;
}

TrajectoryWriter::TrajectoryWriter(std::filesystem::path file, TrajectoryFormat format)
    : path_(std::move(file)), format_(format)
{
  if (format_ == TrajectoryFormat::automatic) {
    throw std::invalid_argument("TrajectoryWriter: the format must be named");
  }
  errno = 0;
  stream_.open(path_);
  if (!stream_) {
    throw FileError::ofSystem(path_, "cannot be created");
  }
  stream_.imbue(std::locale::classic());
}

void TrajectoryWriter::write(const StampedPose& pose)
{
  const Eigen::Matrix3d& r = pose.world_T_sensor.rotation;
  const Eigen::Vector3d& t = pose.world_T_sensor.translation;
  if (format_ == TrajectoryFormat::kitti) {
    stream_ << std::scientific;
    for (Eigen::Index row = 0; row < 3; ++row) {
      stream_ << (row == 0 ? "" : " ") << std::setprecision(9) << r(row, 0) << ' ' << r(row, 1) << ' ' << r(row, 2)
              << ' ' << std::setprecision(12) << t[row];  // micrometres a thousand kilometres from the origin
    }
  } else {
    const Eigen::Quaterniond q = Eigen::Quaterniond(r).normalized();
    stream_ << std::fixed << std::setprecision(6) << pose.stamp << std::setprecision(9);
    for (const double number : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      stream_ << ' ' << number;
    }
  }
  errno = 0;
  stream_ << '\n' << std::flush;
  if (!stream_) {
    throw FileError::ofSystem(path_, "cannot be written");
  }
}

void TrajectoryWriter::writeAgain(const Trajectory& poses)
{
  const std::filesystem::path unfinished = path_.string() + ".part";
  TrajectoryWriter again(unfinished, format_);
  std::error_code error;
  try {
    for (const StampedPose& pose : poses) {
      again.write(pose);
    }
  } catch (const FileError&) {
    std::filesystem::remove(unfinished, error);
    throw;
  }
  std::filesystem::rename(unfinished, path_, error);
  if (error) {
    throw FileError(path_, "cannot be replaced: " + error.message());
  }
  stream_ = std::move(again.stream_);
}

}  // namespace pcl_floam
