/// \file family.h
/// Families of worlds: choices are made on one, reported on another, tested on a third.
#pragma once

#include "random.h"

#include <cstdint>

namespace pcl_floam::simulator {

/// Which family a world belongs to. Families draw from other ranges and from other random numbers: seed 1 of one is
/// not seed 1 of another.
enum class Family {
  tune,    ///< settings are chosen by looking at these
  report,  ///< published figures are of these; nothing is chosen by looking at them
  test     ///< the test suite's
};

/// Range that a generator draws a parameter from.
struct Interval {
  double low = 0.0, high = 0.0;

  /// Uniform in the interval.
  [[nodiscard]] double draw(Random& random) const { return random.uniform(low, high); }
};

/// The random numbers of a family for a seed and a purpose; those of \ref Family::tune are `Random(seed, purpose)`.
[[nodiscard]] inline Random randomOf(Family family, std::uint64_t seed, std::uint64_t purpose)
{
  constexpr std::uint64_t kFamilyPurpose = 1000000000000;  // above the purposes of worlds, paths and sweeps
  return {seed, purpose + kFamilyPurpose * static_cast<std::uint64_t>(family)};
}

}  // namespace pcl_floam::simulator
