/// \file velodyne_bytes.h
/// Packets of a Velodyne that turns evenly within a round wall, and captures of them.
#pragma once

#include "support/recording_bytes.h"

#include <cmath>
#include <string>
#include <vector>

namespace pcl_floam::test {

/// What a sensor is, and how it is set.
struct VelodyneSetting {
  bool hdl32 = false;
  bool dual = false;
  std::uint8_t product = 0x22;
  double turns_per_second = 10.0;
  double first_second = 3599.95;  ///< after the hour: the sensor's clock begins anew soon
  double first_degrees = 0.0;
  double range = 10.0;  ///< m

  [[nodiscard]] double blockPeriod() const { return hdl32 ? 46.08e-6 : 2 * 55.296e-6; }
  [[nodiscard]] int firingsPerPacket() const { return dual ? 6 : 12; }
  [[nodiscard]] double packetPeriod() const { return firingsPerPacket() * blockPeriod(); }
};

/// The packet of that number. Of two returns the first, which is the last by time, is from the wall, the other from
/// half its distance.
inline std::string velodynePacket(const VelodyneSetting& s, int number)
{
  const double begin = number * s.packetPeriod();
  std::string packet;
  for (int block = 0; block < 12; ++block) {
    const double time = begin + (s.dual ? block / 2 : block) * s.blockPeriod();
    const double degrees = std::fmod(s.first_degrees + 360.0 * s.turns_per_second * time, 360.0);
    packet += bytesOf(std::uint16_t{0xEEFF}) + bytesOf(static_cast<std::uint16_t>(std::fmod(100.0 * degrees, 36000.0)));
    for (int laser = 0; laser < 32; ++laser) {
      const double range = s.dual && block % 2 == 1 ? 0.5 * s.range : s.range;
      packet += bytesOf(static_cast<std::uint16_t>(std::lround(range / 0.002))) + bytesOf(std::uint8_t{77});
    }
  }
  const auto microseconds = static_cast<std::uint32_t>(std::fmod(1e6 * (s.first_second + begin), 3600e6));
  return packet + bytesOf(microseconds) + bytesOf(static_cast<std::uint8_t>(s.dual ? 0x39 : 0x37)) + bytesOf(s.product);
}

/// A number as networks have it.
template <typename Number>
std::string networkBytes(Number number)
{
  const std::string bytes = bytesOf(number);
  return {bytes.rbegin(), bytes.rend()};
}

/// An IP packet of UDP.
inline std::string udp(const std::string& data, std::uint8_t host = 201, std::uint16_t port = 2368)
{
  const auto length = static_cast<std::uint16_t>(data.size() + 8);
  return std::string("\x45\0", 2) + networkBytes(static_cast<std::uint16_t>(length + 20)) +
         std::string("\0\0\0\0\x40\x11\0\0", 8) + std::string("\xC0\xA8\x01", 3) + static_cast<char>(host) +
         std::string("\xFF\xFF\xFF\xFF", 4) + networkBytes(std::uint16_t{443}) + networkBytes(port) +
         networkBytes(length) + std::string(2, '\0') + data;
}

inline std::string ethernet(const std::string& ip)
{
  return std::string(12, '\1') + networkBytes(std::uint16_t{0x0800}) + ip;
}

/// Writes captures packet by packet.
class CaptureBytes {
public:
  explicit CaptureBytes(std::uint32_t link = 1, bool nanoseconds = false) : nanoseconds_(nanoseconds)
  {
    bytes_ = bytesOf(nanoseconds ? 0xA1B23C4DU : 0xA1B2C3D4U) + bytesOf(std::uint16_t{2}) + bytesOf(std::uint16_t{4}) +
             std::string(8, '\0') + bytesOf(std::uint32_t{65535}) + bytesOf(link);
  }
  CaptureBytes& packet(double time, const std::string& data)
  {
    const double whole = std::floor(time);
    bytes_ += bytesOf(static_cast<std::uint32_t>(whole)) +
              bytesOf(static_cast<std::uint32_t>((nanoseconds_ ? 1e9 : 1e6) * (time - whole)));
    bytes_ += bytesOf(static_cast<std::uint32_t>(data.size())) + counted(data);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
  bool nanoseconds_;
  std::string bytes_;
};

/// The same as pcapng, by its specification: one section, one interface, one block for each packet.
class NewCaptureBytes {
public:
  explicit NewCaptureBytes(bool nanoseconds) : ticks_(nanoseconds ? 1e9 : 1e6)
  {
    constexpr std::uint16_t kEthernet = 1;
    block(0x0A0D0D0A,
          bytesOf(0x1A2B3C4DU) + bytesOf(std::uint16_t{1}) + bytesOf(std::uint16_t{0}) + bytesOf(std::int64_t{-1}));
    // The option if_tsresol of one byte, filled up to four, and the options' end.
    const std::string resolution = bytesOf(std::uint16_t{9}) + bytesOf(std::uint16_t{1}) + std::string("\x09\0\0\0", 4);
    block(1, bytesOf(kEthernet) + bytesOf(std::uint16_t{0}) + bytesOf(std::uint32_t{0}) +
                 (nanoseconds ? resolution + bytesOf(std::uint32_t{0}) : ""));
  }
  NewCaptureBytes& packet(double time, const std::string& data)
  {
    const auto ticks = static_cast<std::uint64_t>(std::floor(time)) * static_cast<std::uint64_t>(ticks_) +
                       static_cast<std::uint64_t>(ticks_ * (time - std::floor(time)));
    const auto size = static_cast<std::uint32_t>(data.size());
    block(6, bytesOf(std::uint32_t{0}) + bytesOf(static_cast<std::uint32_t>(ticks >> 32U)) +
                 bytesOf(static_cast<std::uint32_t>(ticks)) + bytesOf(size) + bytesOf(size) + data);
    return *this;
  }
  /// A block of another kind, which readers step over.
  NewCaptureBytes& block(std::uint32_t type, std::string body)
  {
    body.resize((body.size() + 3) / 4 * 4, '\0');
    const std::string length = bytesOf(static_cast<std::uint32_t>(body.size() + 12));
    bytes_ += bytesOf(type) + length + body + length;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
  double ticks_;
  std::string bytes_;
};

/// A capture of whole seconds of a sensor.
inline std::string velodyneCapture(const VelodyneSetting& setting, double seconds)
{
  CaptureBytes capture;
  for (int i = 0; i * setting.packetPeriod() < seconds; ++i) {
    capture.packet(1.7e9 + i * setting.packetPeriod(), ethernet(udp(velodynePacket(setting, i))));
  }
  return capture.bytes();
}

}  // namespace pcl_floam::test
