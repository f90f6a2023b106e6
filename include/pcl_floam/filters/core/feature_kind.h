/// \file feature_kind.h
/// The two kinds of features.
#pragma once

#include <cstdint>

namespace pcl_floam {

/// The two kinds of features, and the layers of the map.
enum class FeatureKind : std::uint8_t { edge, plane };

}  // namespace pcl_floam
