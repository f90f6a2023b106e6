#include "smooth_noise.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {
constexpr double kTwoPi = 6.283185307179586;
}

SmoothNoise::SmoothNoise(Random& random, double amplitude, double low, double high, int waves)
{
  const double each = amplitude * std::sqrt(2.0 / waves);
  for (int i = 0; i < waves; ++i) {
    // One wave in each part of the band: no seed leaves a part of it empty.
    const double frequency = low + (high - low) * (i + random.uniform()) / waves;
    waves_.push_back({kTwoPi * frequency, random.uniform(0.0, kTwoPi), each});
  }
}

double SmoothNoise::operator()(double t) const
{
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += wave.amplitude * std::sin(wave.rate * t + wave.phase);
  }
  return sum;
}

void Terrain::addWaves(Random& random, double amplitude, double shortest, double longest, int waves)
{
  const double each = amplitude * std::sqrt(2.0 / waves);
  for (int i = 0; i < waves; ++i) {
    const double k = kTwoPi / random.uniform(shortest, longest);
    const double direction = random.uniform(0.0, kTwoPi);
    waves_.push_back({k * std::cos(direction), k * std::sin(direction), random.uniform(0.0, kTwoPi), each});
  }
}

double Terrain::height(double x, double y) const
{
  double sum = raster_ ? raster_->height(x, y) : 0.0;
  for (const Wave& wave : waves_) {
    sum += wave.amplitude * std::sin(wave.kx * x + wave.ky * y + wave.phase);
  }
  return sum;
}

}  // namespace pcl_floam::simulator
