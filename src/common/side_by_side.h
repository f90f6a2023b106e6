/// \file side_by_side.h
/// Work that shares nothing, done by threads of its own.
#pragma once

#include <cstddef>

namespace pcl_floam {

/// Both, at a time if there is more than one thread.
template <typename First, typename Second>
void sideBySide(int threads, const First& first, const Second& second)
{
#pragma omp parallel sections num_threads(2) if (threads > 1)
  {
#pragma omp section
    first();
#pragma omp section
    second();
  }
}

/// `work(i)` for all i below \p count, in any order. If there are more threads than that, one after the other, each
/// with all threads: those that are started within others cost milliseconds.
template <typename Work>
void eachSideBySide(int threads, std::size_t count, const Work& work)
{
  if (count < static_cast<std::size_t>(threads) || threads == 1) {
    for (std::size_t i = 0; i < count; ++i) {
      work(i);
    }
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (std::size_t i = 0; i < count; ++i) {
    work(i);
  }
}

}  // namespace pcl_floam
