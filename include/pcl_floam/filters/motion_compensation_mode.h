/// \file motion_compensation_mode.h
/// The ways to undo a sweep's distortion that the paper's ablation compares.
#pragma once

#include <cstdint>

namespace pcl_floam {

enum class CompensationMode : std::uint8_t {
  none,       ///< points are used as measured
  two_stage,  ///< the paper's: predicted motion before, optimised motion after the pose estimation
  iterative   ///< LOAM's: compensated anew with every new estimate within the pose iterations
};

[[nodiscard]] const char* toString(CompensationMode mode);

}  // namespace pcl_floam
