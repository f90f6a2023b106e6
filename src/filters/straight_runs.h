/// \file straight_runs.h
/// How far the surface under a return goes straight on.
#pragma once

#include "filters/scan_returns.h"

#include <vector>

namespace pcl_floam {

/// Finds how far each point's scan line goes on straight about it, up to three neighbours to both sides and a step
/// more, and whether what it is on goes straight on across the next scan lines. On such a run a return may have come
/// from anywhere: of the way along it a return tells as little as the run is long. A wall on which a lidar's columns
/// lie far apart then does not look like a row of posts that move along with the sensor, nor one that its lines cross
/// like a stack of bars. As measured: the sensor's turn from one neighbour to the next is neglected.
/// \param[in,out] points of those returns, best in the order of the lines: the next line's neighbour is sought from
///                       where the last point's was; others, of which laser, place and index do not agree, keep their
///                       runs
void findStraightRuns(const ScanReturns& returns, std::vector<ScanPoint>& points);

}  // namespace pcl_floam
