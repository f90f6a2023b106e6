#pragma once

// PCL's own templates, too: its libraries hold them for PCL's point types only, not for PointXYZIRT or yours.
#include <pcl/common/point_tests.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/impl/pcl_base.hpp>

#include <stdexcept>
#include <string>

namespace pcl_floam {

template <typename PointT>
void MotionCompensation<PointT>::setTwist(const Vector6& twist)
{
  if (!twist.allFinite()) {
    throw std::invalid_argument("motion compensation: the motion over the sweep is not finite");
  }
  twist_ = twist;
}

template <typename PointT>
void MotionCompensation<PointT>::setAcceleration(const Vector6& acceleration)
{
  if (!acceleration.allFinite()) {
    throw std::invalid_argument("motion compensation: the acceleration over the sweep is not finite");
  }
  acceleration_ = acceleration;
}

template <typename PointT>
void MotionCompensation<PointT>::checkIndices() const
{
  for (const auto index : *this->indices_) {
    if (index < 0 || static_cast<std::size_t>(index) >= this->input_->size()) {
      throw std::invalid_argument("motion compensation: index " + std::to_string(index) + " is none of the cloud's " +
                                  std::to_string(this->input_->size()) + " points");
    }
  }
}

template <typename PointT>
void MotionCompensation<PointT>::applyFilter(PointCloud& output)
{
  const CloudView cloud = viewOf(*this->input_);
  ScanLines lines;
  timing_ = findScanTiming(cloud, lines, timing_source_);
  if (!timing_.valid() && timing_source_ != ScanTimingSource::none) {  // without a time field, scan lines must tell
    findScanLines(cloud, sensor_, ScanLineSource::automatic, lines);
    timing_ = findScanTiming(cloud, lines, timing_source_);
  }

  if (this->fake_indices_ || !this->indices_) {
    output = *this->input_;
  } else {
    checkIndices();
    pcl::copyPointCloud(*this->input_, *this->indices_, output);
  }
  // Without an acceleration, the velocity of the sweep's middle is that of all instants.
  const SweepMotion motion(twist_, fractionOf(PoseInstant::middle), acceleration_);
  const SE3 reference_T_middle = motion.at(fractionOf(instant_)).inverse();
  if (!timing_.valid() || motion.isStill()) {
    return;
  }
  for (std::size_t i = 0; i < output.size(); ++i) {
    PointT& point = output[i];
    if (!pcl::isXYZFinite(point)) {
      continue;
    }
    const std::size_t source = this->fake_indices_ ? i : static_cast<std::size_t>((*this->indices_)[i]);
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
