/// \file chunked_pool.h
/// Room for many small objects that never move: growing costs one chunk, never a copy of all.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_floam {

/// Objects by number, from 1; 0 stands for none. What was freed is used again first.
template <typename T>
class ChunkedPool {
public:
  ChunkedPool() = default;
  ChunkedPool(const ChunkedPool& other) : free_(other.free_), last_(other.last_), used_(other.used_)
  {
    for (const auto& chunk : other.chunks_) {
      chunks_.push_back(std::make_unique<Chunk>(*chunk));
    }
  }
  ChunkedPool(ChunkedPool&&) noexcept = default;
  ChunkedPool& operator=(ChunkedPool other) noexcept
  {
    chunks_.swap(other.chunks_);
    free_.swap(other.free_);
    std::swap(last_, other.last_);
    std::swap(used_, other.used_);
    return *this;
  }
  ~ChunkedPool() = default;

  T& operator[](std::uint32_t i) { return chunks_[i / kChunk]->at[i % kChunk]; }
  const T& operator[](std::uint32_t i) const { return chunks_[i / kChunk]->at[i % kChunk]; }

  [[nodiscard]] std::size_t used() const { return used_; }

  /// The number of a fresh object.
  std::uint32_t take()
  {
    ++used_;
    if (!free_.empty()) {
      const std::uint32_t i = free_.back();
      free_.pop_back();
      (*this)[i] = T();
      return i;
    }
    ++last_;
    if (last_ / kChunk >= chunks_.size()) {
      chunks_.push_back(std::make_unique<Chunk>());
    }
    return last_;
  }

  void release(std::uint32_t i)
  {
    --used_;
    free_.push_back(i);
  }

  void clear()
  {
    chunks_.clear();
    free_.clear();
    last_ = 0;
    used_ = 0;
  }

private:
  static constexpr std::uint32_t kChunk = 256;
  struct Chunk {
    T at[kChunk];
  };

  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::vector<std::uint32_t> free_;
  std::uint32_t last_ = 0;
  std::size_t used_ = 0;
};

}  // namespace pcl_floam
