// sensor_msgs/PointCloud2

#include "io/messages/scan_messages.h"

#include <pcl_floam/common/core/cloud_view.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pcl_floam {

namespace {

constexpr std::uint32_t kMostFields = 256;
constexpr std::uint64_t kMostMessagePoints = std::numeric_limits<std::int32_t>::max();

/// Bytes of one number of a field's type; 0 for types that the message does not know.
std::uint32_t bytesOf(std::uint8_t datatype)
{
  constexpr std::array<std::uint32_t, 9> kBytes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return datatype < kBytes.size() ? kBytes[datatype] : 0;
}

void takeFields(MessageReader& message, pcl::PCLPointCloud2& cloud)
{
  const auto count = message.number<std::uint32_t>();
  if (count > kMostFields) {
    message.fail("a point of " + std::to_string(count) + " fields: the message is damaged");
  }
  cloud.fields.resize(count);
  for (pcl::PCLPointField& field : cloud.fields) {
    field.name = message.text();
    field.offset = message.number<std::uint32_t>();
    field.datatype = message.number<std::uint8_t>();
    field.count = message.number<std::uint32_t>();
  }
}

std::string fieldNames(const pcl::PCLPointCloud2& cloud)
{
  constexpr std::size_t kMost = 20;
  std::string names;
  for (std::size_t i = 0; i < std::min(kMost, cloud.fields.size()); ++i) {
    names += (i == 0 ? "" : ", ") + cloud.fields[i].name.substr(0, 40);
  }
  return cloud.fields.empty() ? "none" : names;
}

/// A field's end must lie within its point, as every reader of the cloud relies on.
void checkFields(const MessageReader& message, const pcl::PCLPointCloud2& cloud)
{
  for (const pcl::PCLPointField& field : cloud.fields) {
    const std::uint64_t end =
        field.offset + static_cast<std::uint64_t>(bytesOf(field.datatype)) * std::max<std::uint32_t>(field.count, 1);
    if (end > cloud.point_step) {
      message.fail("field '" + field.name.substr(0, 40) + "' ends at byte " + std::to_string(end) + " of a point of " +
                   std::to_string(cloud.point_step) + " bytes (point_step)");
    }
  }
  for (const char* name : {"x", "y", "z"}) {
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [name](const pcl::PCLPointField& candidate) { return candidate.name == name; });
    if (field == cloud.fields.end() ||
        (field->datatype != pcl::PCLPointField::FLOAT32 && field->datatype != pcl::PCLPointField::FLOAT64)) {
      message.refuseKind(
          std::string("the points have no field '") + name +
          "' of type float32 or float64: this topic is no scan, choose another with --topic. Its fields: " +
          fieldNames(cloud));
    }
  }
}

/// Copies the points, row after row without what lies between rows.
void takePoints(const MessageReader& message, std::string_view data, pcl::PCLPointCloud2& cloud)
{
  const std::uint64_t row = static_cast<std::uint64_t>(cloud.width) * cloud.point_step;
  // Drivers of one row, and some of several, do not fill it in.
  const std::uint64_t step = cloud.height <= 1 || cloud.row_step < row ? row : cloud.row_step;
  if (static_cast<std::uint64_t>(cloud.width) * cloud.height > kMostMessagePoints ||
      row > std::numeric_limits<std::uint32_t>::max()) {
    message.fail("the cloud has more points than PCL can count: the message is damaged");
  }
  if (row > 0 && cloud.height > 0 &&
      (data.size() < row || (data.size() - row) / step < static_cast<std::uint64_t>(cloud.height) - 1)) {
    message.fail("the cloud has " + std::to_string(data.size()) + " bytes for " + std::to_string(cloud.width) + " x " +
                 std::to_string(cloud.height) + " points of " + std::to_string(cloud.point_step));
  }
  cloud.row_step = static_cast<std::uint32_t>(row);
  if (step == row) {
    const std::string_view points = data.substr(0, row * cloud.height);
    cloud.data.assign(points.begin(), points.end());
    return;
  }
  cloud.data.clear();
  for (std::uint32_t r = 0; r < cloud.height && row > 0; ++r) {
    const std::string_view points = data.substr(r * step, row);
    cloud.data.insert(cloud.data.end(), points.begin(), points.end());
  }
}

void turnNumbersRound(pcl::PCLPointCloud2& cloud)
{
  for (std::size_t point = 0; point + cloud.point_step <= cloud.data.size() && cloud.point_step > 0;
       point += cloud.point_step) {
    for (const pcl::PCLPointField& field : cloud.fields) {
      const std::uint32_t bytes = bytesOf(field.datatype);
      auto number = cloud.data.begin() + static_cast<std::ptrdiff_t>(point + field.offset);
      for (std::uint32_t i = 0; i < std::max<std::uint32_t>(field.count, 1); ++i, number += bytes) {
        std::reverse(number, number + bytes);
      }
    }
  }
  cloud.is_bigendian = 0;
}

}  // namespace

void decodePointCloud2(MessageReader& message, const VelodyneCalibration* /*none*/, pcl::PCLPointCloud2& cloud)
{
  cloud.header = toPcl(takeHeader(message));
  cloud.height = message.number<std::uint32_t>();
  cloud.width = message.number<std::uint32_t>();
  takeFields(message, cloud);
  cloud.is_bigendian = message.number<std::uint8_t>();
  cloud.point_step = message.number<std::uint32_t>();
  cloud.row_step = message.number<std::uint32_t>();
  const std::string_view data = message.byteSequence();
  cloud.is_dense = 0;  // points that are not finite are let through, whatever the driver says of them
  checkFields(message, cloud);
  takePoints(message, data, cloud);
  if (cloud.is_bigendian != 0) {
    turnNumbersRound(cloud);
  }
  makeCoordinatesFloat(cloud);
}

}  // namespace pcl_floam
