#include "dataset_writer.h"

#include <pcl/io/pcd_io.h>
#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_floam::simulator {

namespace {

/// "000042.pcd"
std::string fileName(std::size_t number, const char* extension)
{
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << number << extension;
  return name.str();
}

void check(bool ok, const std::filesystem::path& path, const char* reason)
{
  if (!ok) {
    throw std::runtime_error(path.string() + ": " + reason);
  }
}

std::ofstream create(const std::filesystem::path& file)
{
  std::ofstream stream(file);
  check(stream.good(), file, "cannot be created");
  stream << std::setprecision(12);
  return stream;
}

/// A scan without a return. PCL refuses to write it, or warns, depending on its version.
int writeEmpty(const std::filesystem::path& file)
{
  std::ofstream stream(file, std::ios::binary);
  stream << "VERSION 0.7\nFIELDS x y z intensity time ring\nSIZE 4 4 4 4 4 2\nTYPE F F F F F U\nCOUNT 1 1 1 1 1 1\n"
         << "WIDTH 0\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA binary\n";
  return stream.good() ? 0 : -1;
}

void addField(pcl::PCLPointCloud2& cloud, const char* name, std::uint8_t type, std::uint32_t size)
{
  pcl::PCLPointField field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = type;
  field.count = 1;
  cloud.fields.push_back(field);
  cloud.point_step += size;
}

template <typename Value>
void append(std::vector<std::uint8_t>& data, const Value& value)
{
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  data.insert(data.end(), bytes, bytes + sizeof(value));
}

/// The fields of Livox's `PointXYZRTLT`, as its driver writes them: without padding.
pcl::PCLPointCloud2 livoxCloud(const Sweep& sweep)
{
  constexpr std::uint8_t kGoodReturn = 0x10;
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    addField(cloud, name, pcl::PCLPointField::FLOAT32, 4);
  }
  addField(cloud, "tag", pcl::PCLPointField::UINT8, 1);
  addField(cloud, "line", pcl::PCLPointField::UINT8, 1);
  addField(cloud, "timestamp", pcl::PCLPointField::FLOAT64, 8);
  for (const PointXYZIRT& point : sweep.cloud) {
    for (const float number : {point.x, point.y, point.z, point.intensity}) {
      append(cloud.data, number);
    }
    append(cloud.data, kGoodReturn);
    append(cloud.data, static_cast<std::uint8_t>(point.ring));
    append(cloud.data, 1e9 * (sweep.start_time + static_cast<double>(point.time)));
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(sweep.cloud.size());
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

int writePcd(const std::filesystem::path& file, const Sweep& sweep, DatasetFormat format)
{
  if (sweep.cloud.empty()) {
    return writeEmpty(file);
  }
  return format == DatasetFormat::livox ? pcl::PCDWriter().writeBinary(file.string(), livoxCloud(sweep))
                                        : pcl::PCDWriter().writeBinary(file.string(), sweep.cloud);
}

void writePose(std::ofstream& stream, const SE3& pose)
{
  const Eigen::Matrix4d matrix = pose.matrix();
  for (Eigen::Index i = 0; i < 12; ++i) {
    stream << (i > 0 ? " " : "") << matrix(i / 4, i % 4);
  }
  stream << std::endl;  // each line at once: a run that is stopped leaves as many poses as scans
}

/// rad, from 0 (front) counter-clockwise to 2 pi
float kittiAzimuth(const PointXYZIRT& point)
{
  const float angle = std::atan2(point.y, point.x);
  return angle < 0.0F ? angle + static_cast<float>(2.0 * M_PI) : angle;
}

}  // namespace

void writeKittiBin(const std::filesystem::path& file, const Sweep& sweep)
{
  // Which ring is the top one depends on the maker's numbering: the means of the elevations tell.
  std::vector<std::pair<double, int>> rings(1);
  for (const PointXYZIRT& point : sweep.cloud) {
    if (point.ring >= rings.size()) {
      rings.resize(point.ring + 1U);
    }
    if (std::isfinite(point.x)) {
      rings[point.ring].first += std::atan2(point.z, std::hypot(point.x, point.y));
      ++rings[point.ring].second;
    }
  }
  std::vector<std::pair<std::array<double, 2>, std::size_t>> order;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const PointXYZIRT& point = sweep.cloud[i];
    if (std::isfinite(point.x)) {
      const auto& [sum, count] = rings[point.ring];
      order.push_back({{-sum / count, kittiAzimuth(point)}, i});
    }
  }
  std::sort(order.begin(), order.end());
  std::ofstream stream(file, std::ios::binary);
  for (const auto& [key, i] : order) {
    const PointXYZIRT& point = sweep.cloud[i];
    const std::array<float, 4> numbers{point.x, point.y, point.z, point.intensity / 255.0F};
    stream.write(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
  }
  stream.flush();
  check(stream.good(), file, "cannot be written");
}

DatasetWriter::DatasetWriter(const std::filesystem::path& folder, DatasetFormat format)
    : scans_(folder / (format == DatasetFormat::kitti ? "velodyne" : "scans")), format_(format)
{
  std::error_code error;
  std::filesystem::create_directories(scans_, error);
  check(!error, scans_, "cannot be created");
  check(std::filesystem::is_empty(scans_), scans_, "holds files already");
  times_ = create(folder / "times.txt");
  starts_ = create(folder / "poses_start.txt");
  middles_ = create(folder / "poses_middle.txt");
  ends_ = create(folder / "poses_end.txt");
}

void DatasetWriter::write(const Sweep& sweep)
{
  if (format_ != DatasetFormat::kitti) {
    const std::filesystem::path file = scans_ / fileName(sweep.number, ".pcd");
    int result = -1;
    try {
      result = writePcd(file, sweep, format_);
    } catch (const pcl::IOException& exception) {
      throw std::runtime_error(file.string() + ": " + exception.what());
    }
    check(result == 0, file, "cannot be written");
  } else {
    writeKittiBin(scans_ / fileName(sweep.number, ".bin"), sweep);
  }
  times_ << sweep.start_time << std::endl;
  writePose(starts_, sweep.world_T_start);
  writePose(middles_, sweep.world_T_middle);
  writePose(ends_, sweep.world_T_end);
  check(times_.good() && starts_.good() && middles_.good() && ends_.good(), scans_.parent_path(), "cannot be written");
}

}  // namespace pcl_floam::simulator
