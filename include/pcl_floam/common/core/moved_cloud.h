/// \file moved_cloud.h
/// A cloud of any point type in another frame.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/se3.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// A copy of a cloud with x, y, z moved and all other fields as they are. Its memory is used again.
class MovedCloud {
public:
  /// \param target_T_source from the cloud's frame to the copy's
  /// \return the copy, until the next call or the object's end
  [[nodiscard]] CloudView take(const CloudView& cloud, const SE3& target_T_source);

private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace pcl_floam
