/// \file vertical_correction.h
/// Correction of a sensor's vertical calibration, as a PCL filter.
#pragma once

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/filters/core/vertical_angle.h>

#include <pcl/filters/filter.h>

namespace pcl_floam {

/// Raises every point of a cloud in the sensor's frame by an angle, seen from the sensor, whose z is its spin axis: for
/// scans whose calibration had the lasers too low. Distances from the sensor stay.
/// \code
/// pcl_floam::VerticalCorrection<pcl::PointXYZI> correction;
/// correction.setInputCloud(scan);
/// correction.setAngle(0.205);          // degrees: KITTI's HDL-64
/// correction.filter(corrected);
/// \endcode
/// Points keep their order and all other fields; normals are turned with them. Points that are not finite, no
/// returns (zero, or at the sensor) and those straight above or below it stay as they are. With indices set, the output
/// holds just those points, in their order; an index that is none of the cloud's points makes `filter` throw
/// std::invalid_argument.
template <typename PointT>
class VerticalCorrection : public pcl::Filter<PointT> {
  using Base = pcl::Filter<PointT>;

public:
  using Ptr = pcl::shared_ptr<VerticalCorrection<PointT>>;
  using ConstPtr = pcl::shared_ptr<const VerticalCorrection<PointT>>;
  using PointCloud = typename Base::PointCloud;

  VerticalCorrection() { this->filter_name_ = "VerticalCorrection"; }

  /// Degrees by which points rise; default 0. Reasonable: -1 to 1.
  /// \throws std::invalid_argument beyond 10 degrees, or if it is not finite
  void setAngle(double degrees);
  [[nodiscard]] double getAngle() const { return degrees_; }

  /// Where the sensor is in the frame of the clouds, if that is not its own but a vehicle's: points rise as
  /// seen from it.
  /// \throws std::invalid_argument for a pose that is not finite
  void setSensorPose(const SE3& frame_T_sensor) { sensor_pose_.set(frame_T_sensor); }
  [[nodiscard]] const SE3& getSensorPose() const { return sensor_pose_.get(); }

  /// 1 or more; the result does not depend on it. 0 uses all processors. Default: 1.
  void setNumberOfThreads(unsigned int threads = 0) { threads_ = threadCount(threads); }
  [[nodiscard]] int getNumberOfThreads() const { return threads_; }

protected:
  void applyFilter(PointCloud& output) override;

private:
  double degrees_ = 0.0;
  SensorPose sensor_pose_;
  int threads_ = 1;
};

}  // namespace pcl_floam

#include <pcl_floam/filters/impl/vertical_correction.hpp>
