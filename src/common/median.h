/// \file median.h
/// The middle of some numbers.
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

namespace pcl_floam {

/// The median, the larger of the two in the middle; 0 of no numbers. Changes the numbers' order.
template <typename Iterator>
[[nodiscard]] auto medianOf(Iterator first, Iterator last)
{
  using T = std::decay_t<decltype(*first)>;
  if (first == last) {
    return T(0);
  }
  const auto middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

template <typename T>
[[nodiscard]] T medianOf(std::vector<T>& numbers)
{
  return medianOf(numbers.begin(), numbers.end());
}

}  // namespace pcl_floam
