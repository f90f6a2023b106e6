#include "scan_pattern.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kRadiansPerDegree = M_PI / 180.0;
constexpr double kFullTurn = 2.0 * M_PI;

/// Livox's prisms turn at 7294 and -4664 a minute (Z. Liu, F. Zhang, X. Hong, "Low-cost Retina-like Robotic Lidars
/// Based on Incommensurable Scanning", 2021); half of the view's 70.4 degrees is what both deflect together. The lasers
/// lie above one another: by the data sheet the view is 77.2 degrees high.
BeamDirection rosette(int laser, int lasers, double time)
{
  constexpr double kDeflection = 0.25 * 70.4 * kRadiansPerDegree;
  constexpr double kSpread = (77.2 - 70.4) * kRadiansPerDegree;
  const double first = kFullTurn * 7294.0 / 60.0 * time;
  const double second = -kFullTurn * 4664.0 / 60.0 * time;
  const double offset = kSpread * ((laser + 0.5) / lasers - 0.5);
  return {kDeflection * (std::cos(first) + std::cos(second)),
          kDeflection * (std::sin(first) + std::sin(second)) + offset};
}

/// The view, -7 to 52 degrees all around, is the data sheet's. The rates are not published: ones that have no common
/// divisor, with some forty waves a turn.
BeamDirection woven(int laser, int lasers, double time)
{
  constexpr double kMiddle = 22.5 * kRadiansPerDegree;
  constexpr double kHeight = 29.5 * kRadiansPerDegree;
  constexpr double kTurns = 10.07;  // 1/s
  constexpr double kNods = 397.3;   // 1/s
  const double phase = kFullTurn * laser / lasers;
  return {std::remainder(kFullTurn * kTurns * time, kFullTurn),
          kMiddle + kHeight * std::sin(kFullTurn * kNods * time + phase)};
}

/// The view, 120 x 25 degrees, is the data sheet's; the rates, which are not published, have no common divisor.
BeamDirection swept(int laser, int lasers, double time)
{
  constexpr double kWidth = 60.0 * kRadiansPerDegree;
  constexpr double kHeight = 25.0 * kRadiansPerDegree;
  constexpr double kSweeps = 101.3;  // 1/s
  constexpr double kShifts = 7.9;    // 1/s
  const double shift = 0.5 * (1.0 + std::sin(kFullTurn * kShifts * time));
  return {kWidth * std::sin(kFullTurn * kSweeps * time), kHeight * ((laser + shift) / lasers - 0.5)};
}

}  // namespace

BeamDirection beamDirection(ScanPattern pattern, int laser, int lasers, double time)
{
  switch (pattern) {
    case ScanPattern::rosette: return rosette(laser, lasers, time);
    case ScanPattern::woven: return woven(laser, lasers, time);
    case ScanPattern::swept: return swept(laser, lasers, time);
    case ScanPattern::turning:
    case ScanPattern::flash: break;
  }
  return {};
}

BeamDirection pixelDirection(int row, int rows, int column, int columns)
{
  return {(0.5 * (columns - 1) - column) * kRadiansPerDegree, (0.5 * (rows - 1) - row) * kRadiansPerDegree};
}

}  // namespace pcl_floam::simulator
