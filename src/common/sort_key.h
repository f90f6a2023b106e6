/// \file sort_key.h
/// Numbers that are not negative, and of what they are, as integers: comparing these is all that sorting needs.
#pragma once

#include <cstdint>
#include <cstring>

namespace pcl_floam {

/// The value's bits, which are in its order, above a number.
[[nodiscard]] inline std::uint64_t sortKey(float value, std::uint32_t number)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return std::uint64_t{bits} << 32U | number;
}

[[nodiscard]] inline float valueOf(std::uint64_t key)
{
  const auto bits = static_cast<std::uint32_t>(key >> 32U);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

}  // namespace pcl_floam
