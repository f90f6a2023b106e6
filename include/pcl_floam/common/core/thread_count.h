/// \file thread_count.h
/// What `setNumberOfThreads` means, as in PCL's OMP classes.
#pragma once

#include <algorithm>
#include <thread>

namespace pcl_floam {

/// \param asked 0: all processors
/// \return 1 or more
[[nodiscard]] inline int threadCount(unsigned int asked)
{
  return static_cast<int>(asked == 0 ? std::max(1U, std::thread::hardware_concurrency()) : asked);
}

}  // namespace pcl_floam
