/// \file pose_instant.h
/// The instant of a sweep that a pose is of.
#pragma once

#include <cstdint>

namespace pcl_floam {

/// The instant of the sweep that a pose describes, and at which compensated points are seen.
enum class PoseInstant : std::uint8_t { start, middle, end };

[[nodiscard]] const char* toString(PoseInstant instant);

/// Fraction of the sweep at which the instant lies: 0, 0.5 or 1.
[[nodiscard]] double fractionOf(PoseInstant instant);

}  // namespace pcl_floam
