// MotionCompensation: what its template does.
#pragma once

#include <pcl_floam/filters/impl/take_points.hpp>

#include <pcl/common/point_tests.h>
#include <pcl/point_types.h>

namespace pcl_floam {

template <typename PointT>
void MotionCompensation<PointT>::applyFilter(PointCloud& output)
{
  const CloudView cloud = sensor_pose_.ofSensor(viewOf(*this->input_));
  ScanLines lines;
  timing_ = findScanTiming(cloud, lines, timing_source_, threads_);
  if (!timing_.valid() && timing_source_ != ScanTimingSource::none) {  // without a time field, scan lines must tell
    findScanLines(cloud, sensor_, ScanLineSource::automatic, lines, threads_);
    timing_ = findScanTiming(cloud, lines, timing_source_, threads_);
  }

  const pcl::Indices* indices = this->fake_indices_ ? nullptr : this->indices_.get();
  takePoints(this->filter_name_, *this->input_, indices, output);
  // Without an acceleration, the velocity of the sweep's middle is that of all instants.
  const SweepMotion motion(twist_, fractionOf(PoseInstant::middle), acceleration_);
  const SE3 reference_T_middle = motion.at(fractionOf(instant_)).inverse();
  if (!timing_.valid() || motion.isStill()) {
    return;
  }
  for (std::size_t i = 0; i < output.size(); ++i) {
    PointT& point = output[i];
    if (!pcl::isXYZFinite(point) || sensor_pose_.isNoReturn(point.getVector3fMap())) {
      continue;
    }
    const std::size_t source = indices == nullptr ? i : static_cast<std::size_t>((*indices)[i]);
    const SE3 reference_T_sensor = reference_T_middle * motion.at(timing_.at(cloud, source));
    point.getVector3fMap() =
        (reference_T_sensor * point.getVector3fMap().template cast<double>()).template cast<float>();
    if constexpr (pcl::traits::has_normal_v<PointT>) {
      point.getNormalVector3fMap() =
          (reference_T_sensor.rotation * point.getNormalVector3fMap().template cast<double>()).template cast<float>();
    }
  }
}

}  // namespace pcl_floam
