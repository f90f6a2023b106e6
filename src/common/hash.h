/// \file hash.h
/// Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4) for tables whose sizes are powers of two.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pcl_floam {

/// \param shift 64 less the bits of the table's size
[[nodiscard]] inline std::size_t hashOf(std::uint64_t key, unsigned shift)
{
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio: spreads all bits upwards
  return static_cast<std::size_t>((key * kGolden) >> shift);
}

}  // namespace pcl_floam
