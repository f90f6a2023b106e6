/// \file laser_support.h
/// Which lasers, in which keyframes, a cell's points came from.
#pragma once

#include <pcl_floam/map/core/surface.h>

#include <cstdint>

namespace pcl_floam {

/// A laser as a bit; those of sensors with more than 64 share them.
inline std::uint64_t laserBit(std::uint32_t laser)
{
  return laser == kNoLaser ? 0 : std::uint64_t{1} << (laser % 64U);
}

/// What one laser draws in one keyframe is a curve on its own cone, whatever it hits: a shape needs several curves. The
/// curve that a laser drew last is where it draws now, if the sensor has hardly moved, and does not testify for it.
class LaserSupport {
public:
  void add(std::uint32_t laser, std::uint32_t keyframe)
  {
    if (keyframe != keyframe_) {
      older_ |= rotated(latest_, keyframe_);
      latest_ = 0;
      keyframe_ = keyframe;
    }
    latest_ |= laserBit(laser);
  }

  /// Whether there are two curves or more without that of \p laser in the map's latest keyframe.
  [[nodiscard]] bool hasTwoBesides(std::uint32_t laser, std::uint32_t latest_keyframe) const
  {
    const std::uint64_t others = keyframe_ == latest_keyframe ? latest_ & ~laserBit(laser) : latest_;
    return areTwo(older_) || areTwo(others) || (older_ != 0 && others != 0);
  }

private:
  static bool areTwo(std::uint64_t bits) { return (bits & (bits - 1)) != 0; }
  /// Another keyframe's curves of the same lasers get bits of their own, mostly: 21 and 64 have no common divisor.
  static std::uint64_t rotated(std::uint64_t bits, std::uint32_t keyframe)
  {
    const std::uint32_t by = (21U * keyframe) % 64U;
    return by == 0 ? bits : (bits << by) | (bits >> (64U - by));
  }

  std::uint64_t older_ = 0;
  std::uint64_t latest_ = 0;
  std::uint32_t keyframe_ = 0;
};

}  // namespace pcl_floam
