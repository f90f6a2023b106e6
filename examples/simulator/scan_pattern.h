/// \file scan_pattern.h
/// Where the beams of a lidar look, from shot to shot.
#pragma once

namespace pcl_floam::simulator {

/// How the beams move over the view.
enum class ScanPattern {
  turning,  ///< a head turns about the z axis: all lasers at one azimuth, each at its own elevation
  rosette,  ///< Livox Avia: two prisms turn against each other; petals that never repeat, 70 degrees across
  woven,    ///< Livox Mid-360: a mirror nods while the head turns; waves around the whole view that never repeat
  swept,    ///< Livox HAP: six beams swept to and fro over 120 x 25 degrees, a little shifted each time
  flash     ///< pixels of one degree, 120 x 60, all at one instant
};

/// A direction; rad. Azimuths are counter-clockwise from the sensor's x axis.
struct BeamDirection {
  double azimuth = 0.0, elevation = 0.0;
};

/// Of the patterns that do not turn: where a laser looks.
/// \param laser one of \p lasers that fire at once
/// \param time  s since the sensor was switched on
[[nodiscard]] BeamDirection beamDirection(ScanPattern pattern, int laser, int lasers, double time);

/// Of `flash`: the direction of a pixel.
[[nodiscard]] BeamDirection pixelDirection(int row, int rows, int column, int columns);

}  // namespace pcl_floam::simulator
