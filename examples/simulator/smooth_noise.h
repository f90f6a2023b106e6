/// \file smooth_noise.h
/// Smooth random functions: of time for swaying bodies, of place for uneven ground.
#pragma once

#include "height_raster.h"
#include "random.h"

#include <memory>
#include <utility>
#include <vector>

namespace pcl_floam::simulator {

/// A random function of time: a sum of sines.
class SmoothNoise {
public:
  /// None at all.
  SmoothNoise() = default;

  /// \param amplitude    standard deviation, in whatever unit
  /// \param low, high    Hz, band of its frequencies
  /// \param waves        number of sines
  SmoothNoise(Random& random, double amplitude, double low, double high, int waves = 5);

  /// \param t s
  [[nodiscard]] double operator()(double t) const;

private:
  struct Wave {
    double rate, phase, amplitude;
  };
  std::vector<Wave> waves_;
};

/// The ground's height as a function of place, m, z up.
class Terrain {
public:
  /// Flat ground at height 0.
  Terrain() = default;

  /// Adds hills or bumps of random direction.
  /// \param amplitude  m, standard deviation of the height
  /// \param shortest, longest  m, wavelengths
  void addWaves(Random& random, double amplitude, double shortest, double longest, int waves = 8);

  /// Lays the ground on a raster instead of height 0.
  void layOn(std::shared_ptr<const HeightRaster> raster) { raster_ = std::move(raster); }

  [[nodiscard]] double height(double x, double y) const;

private:
  std::shared_ptr<const HeightRaster> raster_;

  struct Wave {
    double kx, ky, phase, amplitude;
  };
  std::vector<Wave> waves_;
};

}  // namespace pcl_floam::simulator
