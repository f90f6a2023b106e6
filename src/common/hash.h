/// \file hash.h
/// Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4) for tables whose sizes are powers of two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pcl_floam {

/// \param shift 64 less the bits of the table's size
[[nodiscard]] inline std::size_t hashOf(std::uint64_t key, unsigned shift)
{
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio: spreads all bits upwards
  return static_cast<std::size_t>((key * kGolden) >> shift);
}

/// The key of a place that is met again bit for bit.
[[nodiscard]] inline std::uint64_t keyOf(const std::array<float, 3>& place)
{
  std::array<std::uint32_t, 3> bits;
  std::memcpy(bits.data(), place.data(), sizeof(bits));
  return (std::uint64_t{bits[0]} << 32U | bits[1]) ^ (std::uint64_t{bits[2]} << 16U);
}

}  // namespace pcl_floam
