/// \file line_grouping.h
/// The points of a cloud, sorted by their scan line.
#pragma once

#include "filters/scan_line_finders.h"

#include <pcl_floam/filters/scan_lines.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Asks for each point's line, then lists the points line by line, keeping the cloud's order within a line. Each thread
/// takes points that follow each other: the result does not depend on how many there are.
class LineGrouping {
public:
  static constexpr int kNoLine = -1;

  /// Begins with another cloud, in the same memory.
  /// \param threads >= 1
  /// \param lineOf  gives the line of the measurable point \p i in [0, kMaxScanLines), or \ref kNoLine; called from
  ///                all threads
  template <typename LineOf>
  void assign(const CloudView& points, int threads, const LineOf& lineOf)
  {
    parts_ = static_cast<std::size_t>(threads);
    line_of_point_.resize(points.size);
    counts_.assign(parts_ * kCounts, 0);
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (std::size_t part = 0; part < parts_; ++part) {
      const CloudView cloud = points;  // nobody else's, as the next one: what they hold is read but once
      const LineOf line_of = lineOf;
      std::int32_t* count = &counts_[part * kCounts + kBefore];
      for (std::size_t i = firstOf(part); i < firstOf(part + 1); ++i) {
        const int line = isMeasurable(cloud, i) ? line_of(i) : kNotMeasurable;
        line_of_point_[i] = static_cast<std::int16_t>(line);
        ++count[line];
      }
    }
  }

  [[nodiscard]] std::size_t measurable() const
  {
    return line_of_point_.size() - total(kNotMeasurable);
  }
  [[nodiscard]] std::size_t onLines() const
  {
    return measurable() - total(kNoLine);
  }

  /// Lines that have points.
  [[nodiscard]] int used() const
  {
    int used = 0;
    for (int line = 0; line < kMaxScanLines; ++line) {
      used += total(line) > 0 ? 1 : 0;
    }
    return used;
  }

  /// One more than the number of the last line that has points.
  [[nodiscard]] int end() const
  {
    int end = kMaxScanLines;
    while (end > 0 && total(end - 1) == 0) {
      --end;
    }
    return end;
  }

  /// \param line_count lines to list, >= \ref end
  void list(int line_count, ScanLines& lines)
  {
    const auto count = static_cast<std::size_t>(line_count);
    lines.begin.resize(count + 1);
    next_.resize(parts_ * count);
    std::int32_t listed = 0;
    for (std::size_t m = 0; m < count; ++m) {
      lines.begin[m] = listed;
      for (std::size_t part = 0; part < parts_; ++part) {
        next_[part * count + m] = listed;
        listed += counts_[part * kCounts + kBefore + m];
      }
    }
    lines.begin.back() = listed;
    lines.index.resize(static_cast<std::size_t>(listed));
    const auto threads = static_cast<int>(parts_);
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (std::size_t part = 0; part < parts_; ++part) {
      for (std::size_t i = firstOf(part); i < firstOf(part + 1); ++i) {
        if (line_of_point_[i] >= 0) {
          std::int32_t& place = next_[part * count + static_cast<std::size_t>(line_of_point_[i])];
          lines.index[static_cast<std::size_t>(place++)] = static_cast<std::int32_t>(i);
        }
      }
    }
  }

private:
  static constexpr int kNotMeasurable = -2;
  static constexpr std::size_t kBefore = 2;  ///< places of the counts before line 0: kNotMeasurable and kNoLine
  static constexpr std::size_t kCounts = kBefore + kMaxScanLines;

  [[nodiscard]] std::size_t firstOf(std::size_t part) const
  {
    return line_of_point_.size() * part / parts_;
  }

  [[nodiscard]] std::size_t total(int line) const
  {
    std::size_t total = 0;
    for (std::size_t part = 0; part < parts_; ++part) {
      total += static_cast<std::size_t>((&counts_[part * kCounts + kBefore])[line]);
    }
    return total;
  }

  std::size_t parts_ = 1;
  std::vector<std::int16_t> line_of_point_;
  std::vector<std::int32_t> counts_;  ///< of each part, one after the other
  std::vector<std::int32_t> next_;    ///< places in the list, alike
};

}  // namespace pcl_floam
