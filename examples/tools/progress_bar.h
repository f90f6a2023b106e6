/// \file progress_bar.h
/// How far a run is: a bar on a terminal, a line now and then elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace pcl_floam::tools {

/// Writes to stderr, so that stdout keeps the results alone.
class ProgressBar {
public:
  /// \param quiet show no progress; messages are shown all the same
  ProgressBar(std::size_t total, bool quiet);

  [[nodiscard]] bool isQuiet() const { return quiet_; }

  /// Ends the bar's line, also when an exception cuts the run short.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::size_t done);

  /// A line of its own, above the bar.
  void message(const std::string& line);

private:
  using Clock = std::chrono::steady_clock;

  void draw(std::size_t done);
  void clearBar();

  std::size_t total_;
  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  std::size_t done_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_ = start_;
};

}  // namespace pcl_floam::tools
