/// \file median.h
/// The middle of some numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The median, the larger of the two in the middle; 0 of no numbers. Changes the numbers' order.
template <typename T>
[[nodiscard]] T medianOf(std::vector<T>& numbers)
{
  if (numbers.empty()) {
    return T(0);
  }
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

}  // namespace pcl_floam
