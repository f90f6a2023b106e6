/// \file crc32.h
/// The checksum of mcap, zip and PNG (CRC-32 of IEEE 802.3).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace pcl_floam {

namespace crc32_detail {

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables makeTables()
{
  constexpr std::uint32_t kPolynomial = 0xEDB88320U;
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 1U) != 0 ? (value >> 1U) ^ kPolynomial : value >> 1U;
    }
    tables[0][byte] = value;
  }
  for (std::size_t t = 1; t < tables.size(); ++t) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      tables[t][byte] = (tables[t - 1][byte] >> 8U) ^ tables[0][tables[t - 1][byte] & 0xFFU];
    }
  }
  return tables;
}

inline constexpr Tables kTables = makeTables();

}  // namespace crc32_detail

/// Eight bytes a step: a chunk of a scan's size takes a millisecond.
[[nodiscard]] inline std::uint32_t crc32(std::string_view bytes)
{
  const crc32_detail::Tables& t = crc32_detail::kTables;
  std::uint32_t crc = 0xFFFFFFFFU;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, sizeof(word));
    word ^= crc;
    crc = t[7][word & 0xFFU] ^ t[6][(word >> 8U) & 0xFFU] ^ t[5][(word >> 16U) & 0xFFU] ^ t[4][(word >> 24U) & 0xFFU] ^
          t[3][(word >> 32U) & 0xFFU] ^ t[2][(word >> 40U) & 0xFFU] ^ t[1][(word >> 48U) & 0xFFU] ^ t[0][word >> 56U];
  }
  for (; i < bytes.size(); ++i) {
    crc = (crc >> 8U) ^ t[0][(crc ^ static_cast<std::uint8_t>(bytes[i])) & 0xFFU];
  }
  return ~crc;
}

}  // namespace pcl_floam
