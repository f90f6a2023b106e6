#include "verge.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kDitchWidth = 6.0;   // m across: wide enough for the ground's raster to show it
constexpr double kGrassReach = 25.0;  // m from the carriageway: farther away no beam tells grass from ground
constexpr double kTrunks = 0.3;       // of the bushes are young trees
constexpr double kGrowthClear = 3.0;  // m from the way that nothing grows in

/// 0 below 0, 1 above 1, smooth between.
double smoothStep(double x)
{
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

Verge::Verge(const VergeRanges& ranges, double edge, Random& random)
    : ranges_(ranges),
      edge_(edge),
      side_(edge < 0.0 ? -1.0 : 1.0),
      level_(ranges.level.draw(random)),
      ditch_(random.chance(ranges.ditch_chance) ? ranges.ditch.draw(random) : 0.0),
      bank_(ranges.bank.draw(random)),
      slope_(ranges.slope.draw(random)),
      swell_(random, 0.4, 1.0 / 300.0, 1.0 / 60.0)
{
  bumps_.addWaves(random, ranges.rough.draw(random), 6.0, 20.0);
}

double Verge::height(double along, double left) const
{
  const double beyond = side_ * (left - edge_) - level_;
  if (beyond <= 0.0) {
    return 0.0;
  }
  const double across = std::clamp(beyond / kDitchWidth, 0.0, 1.0);
  const double ditch = -ditch_ * std::sin(M_PI * across);
  const double foot = ditch_ > 0.0 ? kDitchWidth : 0.0;
  const double bank = bank_ * (1.0 + swell_(along)) * smoothStep((beyond - foot) / slope_);
  return ditch + bank + bumps_.height(along, left) * smoothStep(beyond / 4.0);
}

SE3 Verge::place(const Way& way, Random& random, const Interval& aside) const
{
  return besideWay(way, random.uniform(0.0, way.line.length()), edge_ + side_ * aside.draw(random),
                   random.uniform(0.0, 2.0 * M_PI));
}

void Verge::plant(TriangleMesh& mesh, Random& random, const Way& way) const
{
  const double grass = ranges_.grass.draw(random);
  const Interval lawn{ranges_.paved, kGrassReach};
  const double area = way.line.length() * (lawn.high - lawn.low);
  const auto tufts = static_cast<int>(area * ranges_.tufts.draw(random));
  for (int i = 0; i < tufts; ++i) {
    const SE3 foot = place(way, random, lawn);
    const double height = grass * random.uniform(0.3, 1.0);
    if (isClear(way, foot.translation.head<2>(), kGrowthClear)) {
      addFoliage(mesh, random, foot * upright(0.0, 0.0, 0.5 * height), {0.3, 0.3, 0.5 * height}, 0.3 * grass, 5, 0.4);
    }
  }
  if (!random.chance(ranges_.belt_chance)) {
    return;
  }
  const double first = ranges_.belt.draw(random);
  const Interval belt{first, first + ranges_.belt_depth.draw(random)};
  const double tallest = ranges_.height.draw(random);
  double bare = way.line.length() * (belt.high - belt.low) * ranges_.cover.draw(random);
  while (bare > 0.0) {
    const SE3 foot = place(way, random, belt);
    const double half = 0.5 * tallest * random.uniform(0.3, 1.0);
    const double wide = half * random.uniform(0.6, 1.3);
    bare -= M_PI * wide * wide;
    if (isClear(way, foot.translation.head<2>(), kGrowthClear + wide)) {
      // Twigs rather than leaves, as many as hide two thirds of what stands behind.
      const int twigs = 60 + static_cast<int>(150.0 * wide * half);
      addFoliage(mesh, random, foot * upright(0.0, 0.0, 0.8 * half), {wide, wide, half}, 0.15 + 0.05 * half, twigs,
                 0.4);
      if (random.chance(kTrunks)) {
        addCylinder(mesh, foot, random.uniform(0.05, 0.2), random.uniform(1.5, 3.0) * half, 0.3, 0.7, 8);
      }
    }
  }
}

}  // namespace pcl_floam::simulator
