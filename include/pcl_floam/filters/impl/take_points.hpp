// The points of a filter that moves them: all, or those of its indices.
#pragma once

// PCL's own templates, too: its libraries hold them for PCL's point types only, not for PointXYZIRT or yours.
#include <pcl/common/io.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/impl/pcl_base.hpp>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace pcl_floam {

/// What a filter that moves points begins with: the input, or the points that its indices name.
/// \param indices null: all
/// \throws std::invalid_argument for an index that is none of the cloud's points
template <typename PointT>
void takePoints(const std::string& filter, const pcl::PointCloud<PointT>& input, const pcl::Indices* indices,
                pcl::PointCloud<PointT>& output)
{
  if (indices == nullptr) {
    output = input;
    return;
  }
  for (const auto index : *indices) {
    if (index < 0 || static_cast<std::size_t>(index) >= input.size()) {
      throw std::invalid_argument(filter + ": index " + std::to_string(index) + " is none of the cloud's " +
                                  std::to_string(input.size()) + " points");
    }
  }
  pcl::copyPointCloud(input, *indices, output);
}

}  // namespace pcl_floam
