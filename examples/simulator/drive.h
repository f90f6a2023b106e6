/// \file drive.h
/// Driving or walking along a line at a sensible speed.
#pragma once

#include "motion_spline.h"
#include "path_line.h"
#include "smooth_noise.h"

namespace pcl_floam::simulator {

/// How a body moves along its line.
struct DriveStyle {
  double speed = 1.0;              ///< m/s, at most
  double start_speed = 0.0;        ///< m/s
  double end_speed = 0.0;          ///< m/s
  double acceleration = 0.6;       ///< m/s^2, at most, along the line
  double side_acceleration = 0.8;  ///< m/s^2, at most, across it: slows bends
  double left = 0.0;               ///< m, to the left of the line
  double first_station = 0.0;      ///< m along the line where the motion begins
  double last_station = 1e9;       ///< m along the line where it ends; the line's end if that comes first
  double wait = 0.0;               ///< s, stands at the first station before it moves; with a start speed of 0 only
};

/// What the body's height and tilt do meanwhile.
struct BodyStyle {
  double height = 0.0;      ///< m, of the body's origin above the ground
  double wheel_base = 0.0;  ///< m, length and width over which the ground is felt; 0: stays upright
  double sway = 0.0;        ///< rad, standard deviation of pitch and roll on springs (0.4 to 2 Hz)
  double bounce = 0.0;      ///< m, standard deviation of the height on springs (0.5 to 2 Hz)
};

/// The motion of a body that drives along \p line: standing or rolling start, slower in bends, jerks rounded off.
[[nodiscard]] MotionSpline drive(const PathLine& line, const DriveStyle& style, const BodyStyle& body,
                                 const Terrain& terrain, Random& random);

}  // namespace pcl_floam::simulator
