/// \file hdl64_bytes.h
/// Packets of a Velodyne HDL-64 within four walls, whose lasers are all off in ways of their own; and its calibration.
#pragma once

#include "support/constants.h"
#include "support/velodyne_bytes.h"

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_floam::test {

/// In degrees and centimetres, as in db.xml.
struct Hdl64Laser {
  double rotation, elevation, distance, distance_x, distance_y, vertical_offset, horizontal_offset;
};

inline Hdl64Laser hdl64Laser(int i)
{
  const bool upper = i < 32;
  const double distance = 100.0 + 3.0 * (i % 7);
  return {(i % 4 - 1.5) * 4.0 + 0.03 * i,
          upper ? 2.0 - i / 3.0 : -8.83 - 0.5 * (i - 32),
          distance,
          distance + 4.0 + i % 5,
          distance - 3.0 - i % 3,
          upper ? 21.5 : 12.0,
          i % 2 == 0 ? 2.6 : -2.6};
}

inline std::string hdl64Xml(int lasers = 64)
{
  std::ostringstream text;
  text << R"(<?xml version="1.0" encoding="UTF-8" standalone="yes" ?>
<!DOCTYPE boost_serialization>
<boost_serialization signature="serialization::archive" version="4"><DB class_id="0" tracking_level="1" version="0">
<distLSB_>0.2</distLSB_><enabled_><count>64</count><item>1</item></enabled_><points_><count>64</count>
)";
  for (int i = 0; i < lasers; ++i) {
    const Hdl64Laser laser = hdl64Laser(i);
    text << "<item><px class_id=\"10\"><id_>" << i << "</id_>\n<rotCorrection_>" << laser.rotation
         << "</rotCorrection_><vertCorrection_> " << laser.elevation << " </vertCorrection_><distCorrection_>"
         << laser.distance << "</distCorrection_><distCorrectionX_>" << laser.distance_x
         << "</distCorrectionX_><distCorrectionY_>" << laser.distance_y << "</distCorrectionY_><vertOffsetCorrection_>"
         << laser.vertical_offset << "</vertOffsetCorrection_><horizOffsetCorrection_>" << laser.horizontal_offset
         << "</horizOffsetCorrection_><focalDistance_>1500</focalDistance_></px></item>\n";
  }
  text << "</points_></DB></boost_serialization>\n";
  return text.str();
}

inline std::string hdl64Yaml()
{
  std::ostringstream text;
  text.precision(12);
  text << "num_lasers: 64\ndistance_resolution: 0.002\nlasers:\n";
  const double radians = kPi / 180.0;
  for (int i = 0; i < 64; ++i) {
    const Hdl64Laser laser = hdl64Laser(i);
    text << "- {laser_id: " << i << ", rot_correction: " << radians * laser.rotation
         << ", vert_correction: " << radians * laser.elevation << ", dist_correction: " << 0.01 * laser.distance
         << ",\n  dist_correction_x: " << 0.01 * laser.distance_x << ", dist_correction_y: " << 0.01 * laser.distance_y
         << ", vert_offset_correction: " << 0.01 * laser.vertical_offset
         << ", horiz_offset_correction: " << 0.01 * laser.horizontal_offset << ", focal_distance: 15.0}\n";
  }
  return text.str();
}

/// A laser's beam, in m: right, front, up.
struct Hdl64Beam {
  Hdl64Beam(const Hdl64Laser& laser, double azimuth_degrees)
  {
    const double angle = (azimuth_degrees - laser.rotation) * kPi / 180.0;
    const double elevation = laser.elevation * kPi / 180.0;
    const Eigen::Vector3d forward(std::sin(angle), std::cos(angle), 0.0);
    const Eigen::Vector3d right(std::cos(angle), -std::sin(angle), 0.0);
    const Eigen::Vector3d up(0.0, 0.0, 1.0);
    direction = std::cos(elevation) * forward + std::sin(elevation) * up;
    const Eigen::Vector3d across = std::cos(elevation) * up - std::sin(elevation) * forward;
    origin = 0.01 * laser.vertical_offset * across - 0.01 * laser.horizontal_offset * right;
  }
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// What a return should become.
struct Hdl64Return {
  Eigen::Vector3d point;  ///< right, front, up, in m
  int wall = 0;           ///< the coordinate that the wall is across: 0 or 1
};

/// Walls to both sides, in front and behind.
struct Hdl64Room {
  double side = 40.0;   ///< m
  double front = 50.0;  ///< m

  /// \param[out] raw what the sensor sends, in 2 mm
  [[nodiscard]] Hdl64Return measure(int laser_number, double azimuth_degrees, std::uint16_t& raw) const
  {
    const Hdl64Laser laser = hdl64Laser(laser_number);
    const Hdl64Beam beam(laser, azimuth_degrees);
    Hdl64Return hit;
    double range = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 2; ++axis) {
      const double wall = std::copysign(axis == 0 ? side : front, beam.direction[axis]);
      const double there = (wall - beam.origin[axis]) / beam.direction[axis];
      hit.wall = there < range ? axis : hit.wall;
      range = std::min(range, there);
    }
    hit.point = beam.origin + range * beam.direction;
    const double near_by = hit.wall == 0 ? 2.4 : 1.93;
    const double near_correction = 0.01 * (hit.wall == 0 ? laser.distance_x : laser.distance_y);
    const double far_correction = 0.01 * laser.distance;
    double measured = range - far_correction;
    for (int i = 0; i < 50 && measured <= 25.0; ++i) {  // near by, the correction depends on what is measured
      const double coordinate = std::abs((beam.origin + (measured + far_correction) * beam.direction)[hit.wall]);
      const double part = (coordinate - near_by) / (25.04 - near_by);
      measured = range - near_correction - part * (far_correction - near_correction);
    }
    raw = static_cast<std::uint16_t>(std::lround(measured / 0.002));
    return hit;
  }
};

/// The packet of that number, of ten turns a second. \param[out] returns what its points should be
inline std::string hdl64Packet(const Hdl64Room& room, int number, std::vector<Hdl64Return>& returns)
{
  constexpr double kFiring = 48e-6;  // s
  std::string packet;
  for (int firing = 0; firing < 6; ++firing) {
    const double time = kFiring * (6 * number + firing);
    const auto azimuth = static_cast<std::uint16_t>(std::fmod(360000.0 * time, 36000.0));
    for (int block = 0; block < 2; ++block) {
      packet += bytesOf(static_cast<std::uint16_t>(block == 0 ? 0xEEFF : 0xDDFF)) + bytesOf(azimuth);
      for (int i = 0; i < 32; ++i) {
        std::uint16_t raw = 0;
        returns.push_back(room.measure(32 * block + i, 0.01 * azimuth, raw));
        packet += bytesOf(raw) + bytesOf(std::uint8_t{55});
      }
    }
  }
  // The last byte is a state's value: here one that names a VLP-32C in other models' packets.
  return packet + bytesOf(static_cast<std::uint32_t>(1e6 * kFiring * 6 * number)) + "H\x28";
}

inline std::string hdl64Capture(const Hdl64Room& room, int packets, std::vector<Hdl64Return>& returns)
{
  CaptureBytes capture;
  for (int i = 0; i < packets; ++i) {
    capture.packet(1.7e9 + 288e-6 * i, ethernet(udp(hdl64Packet(room, i, returns))));
  }
  return capture.bytes();
}

}  // namespace pcl_floam::test
