/// \file message_reader.h
/// The parts of a ROS message, as ROS 1 and ROS 2 (CDR) write them.
#pragma once

#include "io/byte_reader.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace pcl_floam {

enum class MessageEncoding : std::uint8_t { ros1, cdr };

/// Takes a message apart from front to back. CDR aligns numbers and may be big-endian; ROS 1 does neither.
class MessageReader {
public:
  /// \throws FileError if the message is of CDR and does not begin as one.
  MessageReader(std::string_view bytes, MessageEncoding encoding, const Origin& origin)
      : reader_(bytes, origin), is_cdr_(encoding == MessageEncoding::cdr)
  {
    if (is_cdr_) {
      takeEncapsulation();
    }
  }

  [[nodiscard]] bool isCdr() const { return is_cdr_; }
  [[nodiscard]] std::size_t left() const { return reader_.left(); }

  template <typename Number>
  [[nodiscard]] Number number()
  {
    align(sizeof(Number));
    std::array<char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), reader_.take(sizeof(Number)).data(), sizeof(Number));
    if (swap_) {
      std::reverse(bytes.begin(), bytes.end());
    }
    Number value;
    std::memcpy(&value, bytes.data(), sizeof(Number));
    return value;
  }

  /// A text; CDR's has a zero at its end, which is left out.
  [[nodiscard]] std::string_view text()
  {
    std::string_view bytes = reader_.take(number<std::uint32_t>());
    if (is_cdr_ && !bytes.empty() && bytes.back() == '\0') {
      bytes.remove_suffix(1);
    }
    return bytes;
  }

  /// Bytes with their number before them.
  [[nodiscard]] std::string_view byteSequence() { return reader_.take(number<std::uint32_t>()); }

  [[nodiscard]] std::string_view take(std::uint64_t count) { return reader_.take(count); }
  void skip(std::uint64_t count) { reader_.skip(count); }

  [[noreturn]] void fail(const std::string& reason) const { reader_.fail(reason); }
  /// For what all messages of the topic share. \throws UnreadableKind
  [[noreturn]] void refuseKind(const std::string& reason) const { reader_.refuseKind(reason); }

private:
  static constexpr std::size_t kEncapsulation = 4;  ///< bytes that alignment does not count

  void takeEncapsulation()
  {
    const std::string_view head = reader_.take(kEncapsulation);
    const auto kind = static_cast<std::uint8_t>(head[1]);
    constexpr std::uint8_t kPlainBig = 0;
    constexpr std::uint8_t kPlainLittle = 1;
    constexpr std::uint8_t kPlain2Big = 6;  // XCDR 2 aligns to 4 bytes at most
    constexpr std::uint8_t kPlain2Little = 7;
    if (head[0] != 0 || (kind != kPlainBig && kind != kPlainLittle && kind != kPlain2Big && kind != kPlain2Little)) {
      fail("the message does not begin as plain CDR does");
    }
    swap_ = kind == kPlainBig || kind == kPlain2Big;
    most_aligned_ = kind >= kPlain2Big ? 4 : 8;
  }

  void align(std::size_t size)
  {
    if (is_cdr_) {
      const std::size_t step = std::min(size, most_aligned_);
      const std::size_t beyond = (reader_.position() - kEncapsulation) % step;
      reader_.skip(beyond == 0 ? 0 : step - beyond);
    }
  }

  ByteReader reader_;
  bool is_cdr_ = false;
  bool swap_ = false;
  std::size_t most_aligned_ = 8;
};

}  // namespace pcl_floam
