/// \file scan_pairs.h
/// Pairs of lidar scans, simulated and real.
#pragma once

#include "benchmark/registration_pairs.h"

#include <string>

namespace pcl_floam::benchmark {

/// Scans half a second apart in a simulated world, compensated, with range noise; none without the simulator.
[[nodiscard]] PairKind simulatedScans(const std::string& world, const std::string& sensor, unsigned seed);

/// Consecutive scans of KITTI raw 0001, compensated with the poses, which are good to a few centimetres; none if the
/// folder does not hold them.
/// \param every of so many points, one is taken: for the sake of the slowest method
[[nodiscard]] PairKind realScans(const std::string& data, std::size_t every);

}  // namespace pcl_floam::benchmark
