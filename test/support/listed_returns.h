/// \file listed_returns.h
/// The returns of a scan in a list.
#pragma once

#include "filters/scan_returns.h"

#include <vector>

namespace pcl_floam::test {

/// In the order in which they are read; without times.
inline std::vector<ScanPoint> listed(const ScanReturns& returns)
{
  std::vector<ScanPoint> points;
  ReturnReader reader(returns);
  for (ReturnBatch batch; reader.next(batch);) {
    for (std::size_t n = 0; n < batch.count; ++n) {
      points.push_back(batch.point(n));
    }
  }
  return points;
}

}  // namespace pcl_floam::test
