// livox_ros_driver/CustomMsg

#include "io/messages/scan_messages.h"

#include <limits>

namespace pcl_floam {

namespace {

constexpr std::uint32_t kLivoxPointBytes = 19;  ///< offset_time, x, y, z, reflectivity, tag, line

void describePoints(pcl::PCLPointCloud2& cloud)
{
  using pcl::PCLPointField;
  cloud.fields.clear();
  cloud.point_step = 0;
  addField(cloud, "offset_time", PCLPointField::UINT32, 4);
  for (const char* name : {"x", "y", "z"}) {
    addField(cloud, name, PCLPointField::FLOAT32, 4);
  }
  for (const char* name : {"reflectivity", "tag", "line"}) {
    addField(cloud, name, PCLPointField::UINT8, 1);
  }
}

template <typename Number>
std::uint8_t* store(Number value, std::uint8_t* target)
{
  std::memcpy(target, &value, sizeof(value));
  return target + sizeof(value);
}

}  // namespace

void decodeLivoxCustom(MessageReader& message, const VelodyneCalibration* /*none*/, pcl::PCLPointCloud2& cloud)
{
  cloud.header = toPcl(takeHeader(message));
  (void)message.number<std::uint64_t>();  // timebase: the header's stamp again
  (void)message.number<std::uint32_t>();  // point_num: the number of points again
  (void)message.number<std::uint8_t>();   // lidar_id
  message.skip(3);                        // reserved
  const auto points = message.number<std::uint32_t>();
  if (points > message.left() / kLivoxPointBytes) {
    message.fail("the message has " + std::to_string(message.left()) + " bytes for " + std::to_string(points) +
                 " points of " + std::to_string(kLivoxPointBytes));
  }
  describePoints(cloud);
  cloud.height = 1;
  cloud.width = points;
  cloud.row_step = points * kLivoxPointBytes;
  cloud.is_bigendian = 0;
  cloud.is_dense = 0;
  cloud.data.resize(static_cast<std::size_t>(points) * kLivoxPointBytes);
  std::uint8_t* target = cloud.data.data();
  for (std::uint32_t i = 0; i < points; ++i) {
    target = store(message.number<std::uint32_t>(), target);
    for (int axis = 0; axis < 3; ++axis) {
      target = store(message.number<float>(), target);
    }
    for (int byte = 0; byte < 3; ++byte) {
      target = store(message.number<std::uint8_t>(), target);
    }
  }
}

}  // namespace pcl_floam
