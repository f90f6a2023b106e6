/// \file isolated_returns.h
/// Returns that no other one lies beside, as those of sunlight, other lidars and rain.
#pragma once

#include <pcl_floam/filters/scan_lines.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Kept from scan to scan: its memory is used again.
class IsolatedReturns {
public:
  /// Takes out of a scan's lines what no neighbour bears out, on its own line or in the same direction on the next
  /// ones. Samples that are even in space would hold hardly anything else: each such return has a place of its own.
  /// \return how many
  std::size_t leaveOut(const CloudView& cloud, ScanLines& lines);

private:
  struct Isolated {
    std::int32_t place;  // in the list of the lines
    std::uint32_t line;
  };

  void findOnLine(const CloudView& cloud, const ScanLines& lines, std::size_t line);
  void keepBesideOthers(const CloudView& cloud, const ScanLines& lines);
  void takeOut(ScanLines& lines) const;

  std::vector<float> squared_range_;       // m^2, along a line, and some beyond its ends
  std::vector<float> x_;                   // m, as these
  std::vector<std::int32_t> is_isolated_;  // on it
  std::vector<Isolated> isolated_;
};

}  // namespace pcl_floam
