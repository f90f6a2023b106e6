/// \file scan_messages.h
/// The messages that hold a scan.
#pragma once

#include "io/messages/message_reader.h"
#include "io/velodyne/velodyne_calibration.h"

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <optional>
#include <string_view>

namespace pcl_floam {

/// std_msgs/Header, which all of them begin with.
struct MessageHeader {
  double stamp = 0.0;  ///< s; 0: not set
  std::uint64_t stamp_nanoseconds = 0;
  std::string_view frame;
};

[[nodiscard]] MessageHeader takeHeader(MessageReader& message);

/// PCL's header of a cloud, from the message's.
[[nodiscard]] pcl::PCLHeader toPcl(const MessageHeader& header);

/// Makes a cloud of a message, from its first byte on. \param calibration of an HDL-64, for its packets; may be null
/// \throws FileError if it is damaged, or its packets need a calibration.
using ScanMessageDecoder = void (*)(MessageReader& message, const VelodyneCalibration* calibration,
                                    pcl::PCLPointCloud2& cloud);

/// The decoder for messages of a type, by its ROS 1 or ROS 2 name; nothing if they hold no scan that is read.
[[nodiscard]] std::optional<ScanMessageDecoder> decoderOf(std::string_view type);

/// Whether messages of a type are packets of a Velodyne, which may need a calibration.
[[nodiscard]] bool holdsVelodynePackets(std::string_view type);

/// sensor_msgs/PointCloud2. Bytes between rows go, and big-endian numbers are turned round.
void decodePointCloud2(MessageReader& message, const VelodyneCalibration* calibration, pcl::PCLPointCloud2& cloud);

/// livox_ros_driver/CustomMsg and livox_ros_driver2/CustomMsg: x, y, z, offset_time (ns), reflectivity, tag, line.
void decodeLivoxCustom(MessageReader& message, const VelodyneCalibration* calibration, pcl::PCLPointCloud2& cloud);

/// velodyne_msgs/VelodyneScan: the packets of one turn.
void decodeVelodyneScan(MessageReader& message, const VelodyneCalibration* calibration, pcl::PCLPointCloud2& cloud);

/// Puts a field at the end of a cloud's point.
void addField(pcl::PCLPointCloud2& cloud, const char* name, std::uint8_t type, std::uint32_t bytes);

}  // namespace pcl_floam
