#include "io/messages/scan_messages.h"

#include <algorithm>
#include <string>
#include <utility>

namespace pcl_floam {

MessageHeader takeHeader(MessageReader& message)
{
  constexpr std::uint64_t kNanosecondsPerSecond = 1000000000;
  if (!message.isCdr()) {
    message.skip(sizeof(std::uint32_t));  // seq
  }
  const std::uint64_t seconds = message.number<std::uint32_t>();
  const std::uint64_t nanoseconds = message.number<std::uint32_t>();
  MessageHeader header;
  header.stamp = static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
  header.stamp_nanoseconds = seconds * kNanosecondsPerSecond + nanoseconds;
  header.frame = message.text();
  return header;
}

pcl::PCLHeader toPcl(const MessageHeader& header)
{
  constexpr std::uint64_t kNanosecondsPerMicrosecond = 1000;
  pcl::PCLHeader result;
  result.stamp = header.stamp_nanoseconds / kNanosecondsPerMicrosecond;
  result.frame_id = header.frame;
  return result;
}

namespace {

/// ROS 2 has /msg/ between package and name.
std::string ros1Name(std::string_view type)
{
  constexpr std::string_view kMiddle = "/msg/";
  std::string name(type);
  const std::size_t middle = name.find(kMiddle);
  if (middle != std::string::npos) {
    name.replace(middle, kMiddle.size(), "/");
  }
  return name;
}

constexpr std::string_view kVelodyneScan = "velodyne_msgs/VelodyneScan";

}  // namespace

bool holdsVelodynePackets(std::string_view type)
{
  return ros1Name(type) == kVelodyneScan;
}

std::optional<ScanMessageDecoder> decoderOf(std::string_view type)
{
  constexpr std::array<std::pair<std::string_view, ScanMessageDecoder>, 4> kDecoders{
      {{"sensor_msgs/PointCloud2", decodePointCloud2},
       {"livox_ros_driver/CustomMsg", decodeLivoxCustom},
       {"livox_ros_driver2/CustomMsg", decodeLivoxCustom},
       {kVelodyneScan, decodeVelodyneScan}}};
  const std::string name = ros1Name(type);
  const auto* found =
      std::find_if(kDecoders.begin(), kDecoders.end(), [&name](const auto& decoder) { return decoder.first == name; });
  return found == kDecoders.end() ? std::nullopt : std::optional<ScanMessageDecoder>(found->second);
}

void addField(pcl::PCLPointCloud2& cloud, const char* name, std::uint8_t type, std::uint32_t bytes)
{
  pcl::PCLPointField field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = type;
  field.count = 1;
  cloud.fields.push_back(field);
  cloud.point_step += bytes;
}

}  // namespace pcl_floam
