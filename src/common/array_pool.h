/// \file array_pool.h
/// Memory for many small arrays.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <mutex>

namespace pcl_floam {

/// What one array gives back, the next one of its size takes. Unlike the standard's own pool for several threads it
/// needs no key of the process for each that there is.
class ArrayPool : public std::pmr::memory_resource {
private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return pool_.allocate(bytes, alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pool_.deallocate(memory, bytes, alignment);
  }
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  std::mutex mutex_;
  std::pmr::unsynchronized_pool_resource pool_;
};

}  // namespace pcl_floam
