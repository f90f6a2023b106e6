// velodyne_msgs/VelodyneScan

#include "io/messages/scan_messages.h"
#include "io/velodyne/velodyne_packets.h"

#include <vector>

namespace pcl_floam {

namespace {

struct StampedPacket {
  double stamp = 0.0;
  std::string_view bytes;
};

std::vector<StampedPacket> takePackets(MessageReader& message)
{
  const auto count = message.number<std::uint32_t>();
  if (count > message.left() / kVelodynePacketBytes) {
    message.fail("the message has " + std::to_string(message.left()) + " bytes for " + std::to_string(count) +
                 " packets of " + std::to_string(kVelodynePacketBytes));
  }
  std::vector<StampedPacket> packets(count);
  for (StampedPacket& packet : packets) {
    packet.stamp = message.number<std::uint32_t>();
    packet.stamp += 1e-9 * message.number<std::uint32_t>();
    packet.bytes = message.take(kVelodynePacketBytes);
    if (!isVelodynePacket(packet.bytes)) {
      message.fail("a packet is no data packet of a Velodyne");
    }
  }
  return packets;
}

}  // namespace

void decodeVelodyneScan(MessageReader& message, const VelodyneCalibration* calibration, pcl::PCLPointCloud2& cloud)
{
  const MessageHeader header = takeHeader(message);
  const std::vector<StampedPacket> packets = takePackets(message);
  VelodyneModelFinder finder;
  for (const StampedPacket& packet : packets) {
    finder.add(VelodynePacket(packet.bytes));
  }
  const std::string problem = finder.problem(calibration);
  if (!problem.empty()) {
    message.refuseKind("the scan " + problem);
  }
  if (!finder.model()) {
    message.fail("too few packets (" + std::to_string(packets.size()) + ") to tell the model of the Velodyne");
  }
  // The driver stamps the turn's end, or its beginning: times are relative to that stamp.
  VelodyneCloudBuilder builder(*finder.model(), packets.front().stamp - header.stamp, calibration, cloud);
  for (const StampedPacket& packet : packets) {
    builder.add({packet.bytes});
  }
  builder.finish();
  cloud.header = toPcl(header);
}

}  // namespace pcl_floam
