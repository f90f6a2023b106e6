/// \file hash.h
/// A table of values by 64-bit keys: Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4), open addressing.
#pragma once

#include "common/prefetch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

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

/// Values by 64-bit keys other than 0: open addressing.
template <typename Value>
class HashTable {
public:
  HashTable() { clear(); }

  /// \return Value() for a key that is not there
  [[nodiscard]] Value find(std::uint64_t key) const { return slots_[placeOf(key)].value; }

  /// Lets the processor fetch what \ref find will look at.
  void expect(std::uint64_t key) const { prefetch(&slots_[hashOf(key, shift_)], sizeof(Slot)); }

  /// Begins with Value(). Others may move when a key comes in.
  [[nodiscard]] Value& operator[](std::uint64_t key)
  {
    std::size_t i = placeOf(key);
    if (slots_[i].key == 0) {
      if (2 * ++used_ > slots_.size()) {
        grow();
        i = placeOf(key);
      }
      slots_[i].key = key;
    }
    return slots_[i].value;
  }

  /// The key must be there. What had to make way for it moves up.
  void erase(std::uint64_t key)
  {
    std::size_t hole = placeOf(key);
    for (std::size_t i = next(hole); slots_[i].key != 0; i = next(i)) {
      const std::size_t mask = slots_.size() - 1;
      if (((i - hashOf(slots_[i].key, shift_)) & mask) >= ((i - hole) & mask)) {
        slots_[hole] = slots_[i];
        hole = i;
      }
    }
    slots_[hole] = {};
    --used_;
  }

  /// Keeps room for as many again; smaller tables stay in the cache.
  void clear()
  {
    constexpr unsigned kLeastBits = 10;  // of the table's size
    std::size_t slots = std::size_t{1} << kLeastBits;
    for (shift_ = 64 - kLeastBits; slots < 3 * used_; slots *= 2) {
      --shift_;
    }
    slots_.assign(slots, {});
    used_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return used_; }

private:
  struct Slot {
    std::uint64_t key = 0;
    Value value = {};
  };

  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) & (slots_.size() - 1); }

  /// Where a key is, or where it would come.
  [[nodiscard]] std::size_t placeOf(std::uint64_t key) const
  {
    std::size_t i = hashOf(key, shift_);
    while (slots_[i].key != 0 && slots_[i].key != key) {
      i = next(i);
    }
    return i;
  }

  void grow()
  {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    --shift_;
    for (const Slot& slot : old) {
      if (slot.key != 0) {
        slots_[placeOf(slot.key)] = slot;
      }
    }
  }

  std::vector<Slot> slots_;
  unsigned shift_ = 0;  // leaves as many bits of a hash as number the slots
  std::size_t used_ = 0;
};

}  // namespace pcl_floam
