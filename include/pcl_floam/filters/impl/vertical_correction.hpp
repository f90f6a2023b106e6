// VerticalCorrection: what its template does.
#pragma once

#include <pcl_floam/filters/impl/take_points.hpp>

#include <pcl/common/point_tests.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>

#include <cmath>
#include <stdexcept>

namespace pcl_floam {

template <typename PointT>
void VerticalCorrection<PointT>::setAngle(double degrees)
{
  constexpr double kMost = 10.0;
  if (!(std::abs(degrees) <= kMost)) {
    throw std::invalid_argument("vertical correction: the angle is not within -10 and 10 degrees");
  }
  degrees_ = degrees;
}

template <typename PointT>
void VerticalCorrection<PointT>::applyFilter(PointCloud& output)
{
  takePoints(this->filter_name_, *this->input_, this->fake_indices_ ? nullptr : this->indices_.get(), output);
  const SE3& frame_T_sensor = sensor_pose_.get();
  const SE3 sensor_T_frame = frame_T_sensor.inverse();
  const Eigen::Quaternionf rotation(frame_T_sensor.rotation.template cast<float>());
  for (PointT& point : output) {
    if (!pcl::isXYZFinite(point) || sensor_pose_.isNoReturn(point.getVector3fMap())) {
      continue;
    }
    const Eigen::Vector3f before =
        (sensor_T_frame * point.getVector3fMap().template cast<double>()).template cast<float>();
    Eigen::Vector3f after = before;
    correctVerticalAngle(degrees_, 1, &after.x(), &after.y(), &after.z());
    point.getVector3fMap() = (frame_T_sensor * after.cast<double>()).template cast<float>();
    if constexpr (pcl::traits::has_normal_v<PointT>) {
      const Eigen::Quaternionf turn(rotation * Eigen::Quaternionf::FromTwoVectors(before, after) * rotation.inverse());
      point.getNormalVector3fMap() = turn * point.getNormalVector3fMap();
    }
  }
}

}  // namespace pcl_floam
