/// \file interruption.h
/// Ctrl-C and `kill` end a run after the present scan, with everything written.
#pragma once

namespace pcl_floam::tools {

/// From now on SIGINT and SIGTERM are noted; a second one ends the program at once.
void noteInterruptions();

/// The signal that came, or 0.
[[nodiscard]] int interruptedBy();

}  // namespace pcl_floam::tools
