#include "progress_bar.h"

#include "text_format.h"

#include <cmath>
#include <iostream>

#include <unistd.h>

namespace pcl_floam::tools {

namespace {

constexpr double kBarInterval = 0.1;   // s
constexpr double kLineInterval = 5.0;  // s

std::string clockTime(double seconds)
{
  const long total = std::lround(seconds);
  return total >= 3600 ? formatted("%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60)
                       : formatted("%ld:%02ld", total / 60, total % 60);
}

std::string bar(double fraction)
{
  constexpr int kWidth = 30;
  const int full = static_cast<int>(fraction * kWidth);
  return "[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '.') + "]";
}

}  // namespace

ProgressBar::ProgressBar(std::size_t total, bool quiet)
    : total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0)
{
}

ProgressBar::~ProgressBar()
{
  if (bar_shown_) {
    std::cerr << '\n';
  }
}

void ProgressBar::update(std::size_t done)
{
  done_ = done;
  if (quiet_) {
    return;
  }
  const Clock::time_point now = Clock::now();
  const double interval = terminal_ ? kBarInterval : kLineInterval;
  if (done == total_ || std::chrono::duration<double>(now - last_shown_).count() >= interval) {
    last_shown_ = now;
    draw(done);
  }
}

void ProgressBar::draw(std::size_t done)
{
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = elapsed > 0.0 ? static_cast<double>(done) / elapsed : 0.0;
  std::string line = formatted("%zu/%zu scans, %.1f scans/s", done, total_, rate);
  if (done < total_) {
    line += rate > 0.0 ? ", " + clockTime(static_cast<double>(total_ - done) / rate) + " left" : "";
  } else {
    line += ", took " + clockTime(elapsed);
  }
  if (terminal_) {
    const double fraction = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 1.0;
    std::cerr << "\r\033[K" << bar(fraction) << ' ' << line << std::flush;
    bar_shown_ = true;
  } else {
    std::cerr << line << std::endl;
  }
}

void ProgressBar::clearBar()
{
  if (bar_shown_) {
    std::cerr << "\r\033[K";
    bar_shown_ = false;
  }
}

void ProgressBar::message(const std::string& line)
{
  const bool redraw = bar_shown_;
  clearBar();
  std::cerr << line << std::endl;
  if (redraw) {
    draw(done_);
  }
}

}  // namespace pcl_floam::tools
