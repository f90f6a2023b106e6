/// \file cloud_normals.h
/// Clouds with the normals that PCL estimates.
#pragma once

#include <pcl/features/normal_3d.h>
#include <pcl/memory.h>
#include <pcl/point_cloud.h>

#include <cstddef>

namespace pcl_floam::test {

/// The cloud's coordinates with normals from 20 neighbours each.
template <typename PointN, typename PointT>
typename pcl::PointCloud<PointN>::Ptr withNormals(const pcl::shared_ptr<pcl::PointCloud<PointT>>& cloud)
{
  auto result = pcl::make_shared<pcl::PointCloud<PointN>>();
  pcl::NormalEstimation<PointT, PointN> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(20);
  estimation.compute(*result);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*result)[i].getVector3fMap() = (*cloud)[i].getVector3fMap();
  }
  return result;
}

}  // namespace pcl_floam::test
