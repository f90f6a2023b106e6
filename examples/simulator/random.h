/// \file random.h
/// Random numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>

namespace pcl_floam::simulator {

/// A stream of random numbers.
///
/// The engine's output is fixed by the C++ standard, that of `std::normal_distribution` and its kin is not: the
/// distributions are therefore computed here.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// A stream for one purpose, so that a change in one part of a world leaves the others as they were.
  Random(std::uint64_t seed, std::uint64_t purpose);

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  /// Uniform in [\p low, \p high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in 0 ... \p count - 1.
  int index(int count) { return static_cast<int>(uniform() * count); }

  /// True with probability \p probability.
  bool chance(double probability) { return uniform() < probability; }

  /// Mean 0, standard deviation 1.
  double normal();

private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace pcl_floam::simulator
