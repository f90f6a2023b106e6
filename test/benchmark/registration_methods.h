/// \file registration_methods.h
/// Ours and PCL's registrations behind one call.
#pragma once

#include "benchmark/registration_pairs.h"

#include <string>
#include <vector>

namespace pcl_floam::benchmark {

/// What came of one registration.
struct MethodResult {
  SE3 target_T_source;
  double seconds = 0.0;  ///< with everything that the method needs beside the two clouds, such as normals
};

/// In the table's order; the first is ours.
[[nodiscard]] const std::vector<std::string>& methodNames();

/// Registers a pair by the method of that name, with that guess.
[[nodiscard]] MethodResult runMethod(const std::string& method, const CloudPair& pair, const SE3& guess);

}  // namespace pcl_floam::benchmark
