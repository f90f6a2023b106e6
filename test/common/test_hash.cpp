// The table of values by 64-bit keys.
#include "common/hash.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <unordered_map>

namespace pcl_floam {
namespace {

/// While it grows, keys make way for each other and go, and after it was cleared with many or few in it.
TEST(HashTable, HoldsWhatAMapOfTheStandardHolds)
{
  std::mt19937_64 random(2);
  HashTable<std::uint32_t> table;
  for (const std::uint64_t keys : {50U, 20000U, 300U}) {
    std::unordered_map<std::uint64_t, std::uint32_t> expected;
    for (std::uint32_t i = 1; i <= 4 * keys; ++i) {
      const std::uint64_t key = (1 + random() % keys) << (i % 2 == 0 ? 0U : 40U);
      if (i % 3 == 0 && expected.count(key) > 0) {
        table.erase(key);
        expected.erase(key);
      } else {
        table[key] = i;
        expected[key] = i;
      }
    }
    ASSERT_EQ(table.size(), expected.size());
    for (std::uint64_t k = 1; k <= keys; ++k) {
      for (const std::uint64_t key : {k, k << 40U}) {
        const auto found = expected.find(key);
        ASSERT_EQ(table.find(key), found == expected.end() ? 0U : found->second) << key;
      }
    }
    table.clear();
    EXPECT_EQ(table.size(), 0U);
    EXPECT_EQ(table.find(1), 0U);
  }
}

}  // namespace
}  // namespace pcl_floam
