/// \file stopwatch.h
/// Times of the stages.
#pragma once

#include <chrono>

namespace pcl_floam {

/// Measures consecutive stages in milliseconds.
class Stopwatch {
public:
  void start() { begin_ = last_ = std::chrono::steady_clock::now(); }

  /// Milliseconds since the last lap.
  double lap()
  {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

  /// Milliseconds since the start.
  [[nodiscard]] double total() const
  {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
  }

private:
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace pcl_floam
