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
  ChunkedPool(const ChunkedPool& other) : free_(other.free_), last_(other.last_), ever_(other.ever_), used_(other.used_)
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
    std::swap(ever_, other.ever_);
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
    std::uint32_t i = 0;
    if (!free_.empty()) {
      i = free_.back();
      free_.pop_back();
    } else {
      i = ++last_;
    }
    if (i <= ever_) {
      (*this)[i] = T();
      return i;
    }
    ever_ = i;
    if (i / kChunk >= chunks_.size()) {
      chunks_.push_back(std::unique_ptr<Chunk>(new Chunk));  // not filled with zeros before its objects are made
    }
    return i;
  }

  void release(std::uint32_t i)
  {
    --used_;
    free_.push_back(i);
  }

  /// Keeps the room.
  void clear()
  {
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
  std::uint32_t ever_ = 0;  // the last one before the room was cleared, if that is more
  std::size_t used_ = 0;
};

}  // namespace pcl_floam
