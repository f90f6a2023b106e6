/// \file chunked_pool.h
/// Room for many small objects that never move: growing costs one chunk, never a copy of all.
#pragma once

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Objects by number, from 1; 0 stands for none. What was freed is used again first.
template <typename T>
class ChunkedPool {
public:
  T& operator[](std::uint32_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const T& operator[](std::uint32_t i) const { return chunks_[i / kChunk][i % kChunk]; }

  /// The number of a fresh object.
  std::uint32_t take()
  {
    std::uint32_t i = last_ + 1;
    if (free_.empty()) {
      last_ = i;
    } else {
      i = free_.back();
      free_.pop_back();
    }
    if (i / kChunk < chunks_.size()) {
      (*this)[i] = T();
    } else {
      chunks_.emplace_back(kChunk);
    }
    return i;
  }

  void release(std::uint32_t i) { free_.push_back(i); }

  /// Keeps the room.
  void clear()
  {
    free_.clear();
    last_ = 0;
  }

private:
  static constexpr std::uint32_t kChunk = 256;

  std::vector<std::vector<T>> chunks_;
  std::vector<std::uint32_t> free_;
  std::uint32_t last_ = 0;
};

}  // namespace pcl_floam
