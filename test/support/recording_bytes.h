/// \file recording_bytes.h
/// Bytes of recordings and their messages, written by the formats' specifications.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pcl_floam::test {

/// A number as it lies in memory.
template <typename Number>
std::string bytesOf(Number number)
{
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

/// With its length before it.
template <typename Length = std::uint32_t>
std::string counted(const std::string& bytes)
{
  return bytesOf(static_cast<Length>(bytes.size())) + bytes;
}

/// A ROS message, number after number.
class MessageBytes {
public:
  explicit MessageBytes(bool cdr, bool big_endian = false) : cdr_(cdr), big_endian_(big_endian) {}

  template <typename Number>
  MessageBytes& number(Number value)
  {
    while (cdr_ && bytes_.size() % sizeof(Number) != 0) {
      bytes_ += '\0';
    }
    std::string number = bytesOf(value);
    bytes_ += big_endian_ ? std::string(number.rbegin(), number.rend()) : number;
    return *this;
  }
  MessageBytes& text(const std::string& value)
  {
    const std::string ended = cdr_ ? value + '\0' : value;
    number(static_cast<std::uint32_t>(ended.size()));
    bytes_ += ended;
    return *this;
  }
  MessageBytes& raw(const std::string& bytes)
  {
    bytes_ += bytes;
    return *this;
  }
  MessageBytes& header(std::uint32_t seconds = 1700000000, std::uint32_t nanoseconds = 500000000)
  {
    if (!cdr_) {
      number(std::uint32_t{7});  // seq
    }
    return number(seconds).number(nanoseconds).text("lidar");
  }
  [[nodiscard]] std::string bytes() const
  {
    return cdr_ ? std::string("\0", 1) + (big_endian_ ? '\0' : '\1') + std::string(2, '\0') + bytes_ : bytes_;
  }

private:
  bool cdr_;
  bool big_endian_;
  std::string bytes_;
};

/// A PointCloud2's shape, good by itself.
struct CloudShape {
  std::uint32_t width = 2;
  std::uint32_t height = 1;
  std::uint32_t point_step = 12;
  std::uint32_t row_step = 24;
  std::uint32_t z_offset = 8;
  bool big_endian = false;
  bool float64 = false;  ///< x, y, z; their offsets then are doubled
  std::string data = bytesOf(1.0F) + bytesOf(2.0F) + bytesOf(3.0F) + bytesOf(4.0F) + bytesOf(5.0F) + bytesOf(6.0F);
};

inline std::string pointCloud2(const CloudShape& shape, MessageBytes message = MessageBytes(true),
                               std::uint32_t seconds = 1700000000, std::uint32_t nanoseconds = 500000000)
{
  message.header(seconds, nanoseconds).number(shape.height).number(shape.width).number(std::uint32_t{3});
  const std::uint32_t offsets[] = {0, 4, shape.z_offset};
  const char* names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    message.text(names[i]).number((shape.float64 ? 2 : 1) * offsets[i]);
    message.number(static_cast<std::uint8_t>(shape.float64 ? 8 : 7)).number(std::uint32_t{1});
  }
  message.number(static_cast<std::uint8_t>(shape.big_endian)).number(shape.point_step).number(shape.row_step);
  message.number(static_cast<std::uint32_t>(shape.data.size())).raw(shape.data).number(std::uint8_t{1});
  return message.bytes();
}

inline std::string mcapRecord(std::uint8_t opcode, const std::string& content)
{
  return bytesOf(opcode) + counted<std::uint64_t>(content);
}

inline std::string mcapMessage(std::uint16_t channel, std::uint64_t time, const std::string& data)
{
  return mcapRecord(5, bytesOf(channel) + bytesOf(std::uint32_t{0}) + bytesOf(time) + bytesOf(time) + data);
}

/// A file of one topic, without chunks.
inline std::string mcapFile(const std::string& type, const std::string& encoding,
                            const std::vector<std::string>& messages)
{
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string file = magic + mcapRecord(1, counted("") + counted("test"));
  file += mcapRecord(3, bytesOf(std::uint16_t{1}) + counted(type) + counted("") + counted(""));
  file += mcapRecord(
      4, bytesOf(std::uint16_t{1}) + bytesOf(std::uint16_t{1}) + counted("/points") + counted(encoding) + counted(""));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    file += mcapMessage(1, 1000000000U * i, messages[i]);
  }
  return file + mcapRecord(15, std::string(4, '\0')) + mcapRecord(2, std::string(20, '\0')) + magic;
}

inline std::string bagField(const std::string& name, const std::string& value)
{
  return counted(name + "=" + value);
}

inline std::string bagRecord(std::uint8_t op, const std::string& fields, const std::string& data)
{
  return counted(bagField("op", bytesOf(op)) + fields) + counted(data);
}

}  // namespace pcl_floam::test
