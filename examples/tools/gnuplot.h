/// \file gnuplot.h
/// Runs gnuplot.
#pragma once

#include <string>

namespace pcl_floam::tools {

/// Has gnuplot run a script.
/// \return empty, or in one line why it did not
[[nodiscard]] std::string runGnuplot(const std::string& script);

}  // namespace pcl_floam::tools
