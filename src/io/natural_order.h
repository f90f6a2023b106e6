/// \file natural_order.h
/// scan2 before scan10.
#pragma once

#include <string_view>

namespace pcl_floam {

/// Natural order: runs of digits compare as the numbers they are, however long.
[[nodiscard]] bool naturallyBefore(std::string_view a, std::string_view b);

}  // namespace pcl_floam
