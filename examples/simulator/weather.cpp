#include "weather.h"

#include <cmath>
#include <limits>

namespace pcl_floam::simulator {

namespace {

constexpr double kDecibelPerKilometre = 2.302585093e-4;  // 1/m of power: ln(10)/10 over 1000 m
constexpr double kReturnReach = 4.0;                     // m, mean range of false returns, as in fog and snow outdoors

/// False returns per beam for each unit of extinction, m: so that moderate rain (10 mm/h) gives about 1 % and fog or
/// dust of 30 m visibility most of the beams a false return.
constexpr double kReturnsByExtinction = 8.0;

/// Flakes are larger than drops of the same water and fewer: one is far more often seen by itself.
constexpr double kFlakes = 3.0;

double extinctionOfRain(double rain)
{
  // ITU-R P.1814 (after Carbonneau): 1.076 R^0.67 dB/km.
  return rain > 0.0 ? kDecibelPerKilometre * 1.076 * std::pow(rain, 0.67) : 0.0;
}

double extinctionOfSnow(double snow)
{
  // ITU-R P.1814, dry snow at 905 nm: 5.54 S^1.38 dB/km.
  return snow > 0.0 ? kDecibelPerKilometre * 5.54 * std::pow(snow, 1.38) : 0.0;
}

}  // namespace

double Weather::extinction() const
{
  return extinctionOfRain(rain) + extinctionOfSnow(snow) + dust;
}

double Weather::transmission(double range) const
{
  return std::exp(-2.0 * extinction() * range);
}

double Weather::drawReturn(Random& random) const
{
  const double expected = kReturnsByExtinction * (extinction() + (kFlakes - 1.0) * extinctionOfSnow(snow));
  const bool returns = random.chance(1.0 - std::exp(-expected));
  const double range = -kReturnReach * std::log(1.0 - random.uniform());
  return returns ? range : std::numeric_limits<double>::infinity();
}

}  // namespace pcl_floam::simulator
