#include "io/velodyne/velodyne_calibration.h"

#include "io/text.h"
#include "io/velodyne/laser_table.h"
#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pcl_floam {

namespace {

constexpr std::uintmax_t kMostCalibrationBytes = 1U << 20U;  ///< the makers' files have a tenth of it

bool isCalibrationXml(std::string_view content)
{
  const std::size_t first = content.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // and a byte order mark
  return first != std::string_view::npos && content[first] == '<';
}

bool isCalibrationYaml(std::string_view content)
{
  while (!content.empty()) {
    const std::vector<std::string_view> words = splitWords(takeLine(content));
    if (!words.empty() && (words.front() == "lasers:" || words.front().substr(0, 8) == "{lasers:")) {
      return true;
    }
  }
  return false;
}

std::string readCalibrationFile(const std::filesystem::path& file)
{
  std::error_code error;
  if (std::filesystem::file_size(file, error) > kMostCalibrationBytes && !error) {
    throw FileError(file, "is too large for a calibration");
  }
  return readWholeFile(file);
}

/// A number within what a sensor can have: a unit that was taken for another, or damage, would make points that lie
/// somewhere.
double believable(const std::filesystem::path& file, const LaserNumbers& numbers, const char* name, double most)
{
  const auto found = numbers.find(std::string_view(name));
  const double value = found == numbers.end() ? 0.0 : found->second;
  if (!(std::abs(value) <= most)) {
    throw FileError(file, std::string(name) + " of laser " + std::to_string(numbers.at("laser_id")).substr(0, 4) +
                              " is " + std::to_string(value) + " (rad, m), more than any sensor has");
  }
  return value;
}

LaserCorrection correctionOf(const std::filesystem::path& file, const LaserNumbers& numbers)
{
  constexpr double kMostAngle = 0.8;     // rad; the lasers see from -25 to 2 degrees, and within 9 degrees aside
  constexpr double kMostDistance = 5.0;  // m; usual are 1 to 1.5
  constexpr double kMostOffset = 0.5;    // m; the sensor is smaller
  LaserCorrection laser;
  laser.rotation = believable(file, numbers, "rot_correction", kMostAngle);
  laser.elevation = believable(file, numbers, "vert_correction", kMostAngle);
  laser.distance = believable(file, numbers, "dist_correction", kMostDistance);
  if (numbers.count("dist_correction_x") + numbers.count("dist_correction_y") == 2) {
    laser.distance_x = believable(file, numbers, "dist_correction_x", kMostDistance);
    laser.distance_y = believable(file, numbers, "dist_correction_y", kMostDistance);
  }
  laser.vertical_offset = believable(file, numbers, "vert_offset_correction", kMostOffset);
  laser.horizontal_offset = believable(file, numbers, "horiz_offset_correction", kMostOffset);
  return laser;
}

void numberRings(VelodyneCalibration& calibration)
{
  for (LaserCorrection& laser : calibration.lasers) {
    laser.ring = static_cast<std::uint16_t>(
        std::count_if(calibration.lasers.begin(), calibration.lasers.end(), [&](const LaserCorrection& other) {
          return other.elevation < laser.elevation || (other.elevation == laser.elevation && &other < &laser);
        }));
  }
}

/// Between the distances at which a laser was calibrated, the correction is interpolated; beyond the far one it stays.
double correctionAt(double coordinate, double near_by, double near_correction, double far_correction)
{
  constexpr double kFar = 25.04;  // m; where the makers calibrate
  return near_correction + (far_correction - near_correction) * (coordinate - near_by) / (kFar - near_by);
}

}  // namespace

VelodyneCalibration readVelodyneCalibration(const std::filesystem::path& file)
{
  const std::string content = readCalibrationFile(file);
  const bool is_xml = isCalibrationXml(content);
  if (!is_xml && !isCalibrationYaml(content)) {
    throw FileError(file,
                    "is no calibration of a Velodyne's lasers: its db.xml or the YAML of the ROS driver is asked "
                    "for");
  }
  const LaserTable table = is_xml ? lasersOfXml(file, content) : lasersOfYaml(file, content);
  VelodyneCalibration calibration;
  std::array<bool, kHdl64Lasers> given{};
  for (const LaserNumbers& numbers : table.lasers) {
    const double id = numbers.at("laser_id");
    // Some files have entries for lasers that the sensor does not have.
    if (id >= 0.0 && id < static_cast<double>(kHdl64Lasers) && id == std::floor(id)) {
      calibration.lasers[static_cast<std::size_t>(id)] = correctionOf(file, numbers);
      given[static_cast<std::size_t>(id)] = true;
    }
  }
  const auto count = std::count(given.begin(), given.end(), true);
  if (count != static_cast<std::ptrdiff_t>(kHdl64Lasers)) {
    throw FileError(file, "has corrections of " + std::to_string(count) + " lasers, but an HDL-64 has 64");
  }
  constexpr double kFinest = 0.0005;  // m
  constexpr double kCoarsest = 0.02;
  calibration.distance_unit = table.distance_unit.value_or(calibration.distance_unit);
  if (!(calibration.distance_unit >= kFinest && calibration.distance_unit <= kCoarsest)) {
    throw FileError(file, "distances in units of " + std::to_string(calibration.distance_unit) +
                              " m: 0.002 m is what these sensors have");
  }
  numberRings(calibration);
  return calibration;
}

bool isLaserCalibration(const std::filesystem::path& file)
{
  const std::string content = readCalibrationFile(file);
  return isCalibrationXml(content) || isCalibrationYaml(content);
}

LaserPoint calibratedPoint(const LaserCorrection& laser, double azimuth, double distance)
{
  constexpr double kNearX = 2.4;   // m; where the makers calibrate to the right
  constexpr double kNearY = 1.93;  // m; and to the front
  constexpr double kFar = 25.0;    // m; beyond it one correction is good for both
  const double angle = azimuth - laser.rotation;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double up = std::sin(laser.elevation);
  const double flat = std::cos(laser.elevation);
  // The beam leaves beside the axis: across it by the vertical offset, and to the left.
  const auto right = [&](double range) {
    return (range * flat - laser.vertical_offset * up) * sine - laser.horizontal_offset * cosine;
  };
  const auto front = [&](double range) {
    return (range * flat - laser.vertical_offset * up) * cosine + laser.horizontal_offset * sine;
  };
  double range_x = distance + laser.distance;
  double range_y = range_x;
  if (laser.distance_x && laser.distance_y && distance <= kFar) {
    const double far_off = distance + laser.distance;
    range_x = distance + correctionAt(std::abs(right(far_off)), kNearX, *laser.distance_x, laser.distance);
    range_y = distance + correctionAt(std::abs(front(far_off)), kNearY, *laser.distance_y, laser.distance);
  }
  // Heights go with the distance to the front, as the manual has it.
  return {front(range_y), -right(range_x), range_y * up + laser.vertical_offset * flat};
}

}  // namespace pcl_floam
