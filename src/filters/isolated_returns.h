/// \file isolated_returns.h
/// Returns that no other one lies beside, as those of rain, dust, sunlight and other lidars.
#pragma once

#include <pcl_floam/filters/core/scan_points.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Kept from scan to scan: its memory is used again.
class IsolatedReturns {
public:
  /// Takes out of the scan lines what no neighbour bears out, on its own line or in the same direction on the next
  /// ones. Samples that are even in space would hold hardly anything else: each such return has a place of its own.
  /// \param returns that refer to those lines
  void leaveOut(const ScanReturns& returns, ScanLines& lines);

private:
  void findAloneOnLine(const ScanReturns& returns, std::size_t line);
  void keepBesideOthers(const ScanReturns& returns);
  void takeOut(ScanLines& lines) const;

  std::vector<float> squared_range_;    // m^2, of a line
  std::vector<std::int32_t> is_alone_;  // on it
  std::vector<ScanPoint> alone_;        // of all lines
};

}  // namespace pcl_floam
