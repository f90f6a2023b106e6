/// \file motion_compensation_mode.h
/// How and to which instant a sweep's distortion is undone.
#pragma once

#include <cstdint>

namespace pcl_floam {

/// The ways to undo the distortion that the paper's ablation compares.
enum class CompensationMode : std::uint8_t {
  none,       ///< points are used as measured
  two_stage,  ///< the paper's: predicted motion before, optimised motion after the pose estimation
  iterative,  ///< LOAM's: compensated anew with every new estimate within the pose iterations
  /// The motion during the sweep is estimated together with the pose, under a constant-velocity prior; by features,
  /// which have no such prior, it is `iterative`.
  continuous
};

[[nodiscard]] const char* toString(CompensationMode mode);

/// The instant of the sweep that a pose describes, and at which compensated points are seen.
enum class PoseInstant : std::uint8_t { start, middle, end };

[[nodiscard]] const char* toString(PoseInstant instant);

/// Fraction of the sweep at which the instant lies: 0, 0.5 or 1.
[[nodiscard]] double fractionOf(PoseInstant instant);

}  // namespace pcl_floam
