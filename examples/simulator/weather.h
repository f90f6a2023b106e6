/// \file weather.h
/// Rain, snow, dust and other light between a lidar and what it sees.
#pragma once

#include "random.h"

namespace pcl_floam::simulator {

/// What falls or floats in the air.
struct Weather {
  double rain = 0.0;  ///< mm/h
  double snow = 0.0;  ///< mm/h of water
  double dust = 0.0;  ///< 1/m, extinction; visibility is about 3 over it
  /// Part of the beams for whose echo sunlight or another lidar is taken, at any range.
  double stray = 0.0;

  [[nodiscard]] bool isClear() const { return rain <= 0.0 && snow <= 0.0 && dust <= 0.0; }

  /// 1/m, part of the light that is lost on the way.
  [[nodiscard]] double extinction() const;

  /// Part of the light that is left when it comes back from \p range m.
  [[nodiscard]] double transmission(double range) const;

  /// The range that a drop, flake or cloud of dust returns the beam from, m; infinite if none does.
  [[nodiscard]] double drawReturn(Random& random) const;
};

}  // namespace pcl_floam::simulator
