// VerticalCorrection: what its template does.
#pragma once

#include <pcl_floam/filters/impl/take_points.hpp>

#include <pcl/common/point_tests.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

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
  std::vector<std::size_t> measured;
  std::vector<float> x, y, z;
  for (std::size_t i = 0; i < output.size(); ++i) {
    const PointT& point = output[i];
    if (pcl::isXYZFinite(point) && !sensor_pose_.isNoReturn(point.getVector3fMap())) {
      const Eigen::Vector3d seen = sensor_T_frame * point.getVector3fMap().template cast<double>();
      measured.push_back(i);
      x.push_back(static_cast<float>(seen.x()));
      y.push_back(static_cast<float>(seen.y()));
      z.push_back(static_cast<float>(seen.z()));
    }
  }
  const std::vector<float> from_x = x, from_y = y, from_z = z;
  correctVerticalAngle(degrees_, measured.size(), x.data(), y.data(), z.data(), threads_);
  for (std::size_t n = 0; n < measured.size(); ++n) {
    PointT& point = output[measured[n]];
    const Eigen::Vector3f after(x[n], y[n], z[n]);
    point.getVector3fMap() = (frame_T_sensor * after.cast<double>()).template cast<float>();
    if constexpr (pcl::traits::has_normal_v<PointT>) {
      const Eigen::Vector3f before(from_x[n], from_y[n], from_z[n]);
      const Eigen::Quaternionf turn(rotation * Eigen::Quaternionf::FromTwoVectors(before, after) * rotation.inverse());
      point.getNormalVector3fMap() = turn * point.getNormalVector3fMap();
    }
  }
}

}  // namespace pcl_floam
