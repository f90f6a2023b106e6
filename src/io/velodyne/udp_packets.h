/// \file udp_packets.h
/// UDP datagrams of a capture file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace pcl_floam {

/// What a datagram carries, and who sent it. Valid until the next.
struct Datagram {
  std::string sender;  ///< address:port that it was sent to
  std::string_view data;
  double time = 0.0;         ///< s; when it was captured
  std::int64_t place = 0;    ///< of its packet in the file, to come back to
  std::uint64_t number = 0;  ///< of its packet, from 1 on, as programs that show captures count
};

/// Reads a capture from packet to packet, by libpcap.
class UdpPackets {
public:
  /// \throws FileError if the file is no capture, or libpcap was left out of this build.
  explicit UdpPackets(const std::filesystem::path& file);
  ~UdpPackets();
  UdpPackets(const UdpPackets&) = delete;
  UdpPackets& operator=(const UdpPackets&) = delete;

  /// \return false at the file's end \throws FileError if the file ends within a packet or is damaged
  [[nodiscard]] bool next(Datagram& datagram);

  /// Goes back to a packet that was read before.
  void seek(std::int64_t place, std::uint64_t number);

private:
  class Capture;
  std::unique_ptr<Capture> capture_;
};

}  // namespace pcl_floam
