/// \file stage_benchmarks.h
/// The odometry's stages, and what PCL needs for comparable work, as benchmarks of one program.
#pragma once

#include "benchmark/stage_inputs.h"

namespace pcl_floam::benchmark {

/// What PCL needs to filter the scan by voxels of half a metre and to build one FLANN KD-tree over the result: the
/// unit in which the odometry's cost is told. \return number of points left
std::size_t runReference(const CloudXYZI::ConstPtr& cloud);

/// Each stage on the last scan of a sequence.
void registerStages(const ScanSequence& sequence);

/// The whole odometry over a sequence, scan by scan, beside the reference on the same scans.
/// \param threads of the odometry
void registerPipeline(const ScanSequence& sequence, int threads);

/// How the cost grows with the points of a scan, the features and the map.
void registerGrowth(const ScanSequence& sequence);

}  // namespace pcl_floam::benchmark
