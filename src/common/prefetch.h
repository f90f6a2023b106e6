/// \file prefetch.h
/// Asking for memory before it is needed.
#pragma once

#include <cstddef>

namespace pcl_floam {

/// Lets the processor fetch \p bytes from \p address on while it goes on with other work. Any address will do.
inline void prefetch(const void* address, std::size_t bytes)
{
  constexpr std::size_t kCacheLine = 64;
  for (std::size_t offset = 0; offset < bytes; offset += kCacheLine) {
    __builtin_prefetch(static_cast<const char*>(address) + offset);
  }
}

}  // namespace pcl_floam
