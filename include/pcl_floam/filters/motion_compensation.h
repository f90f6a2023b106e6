/// \file motion_compensation.h
/// The undoing of a sweep's distortion as a PCL filter.
#pragma once

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/filters/core/pose_instant.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/core/sensor_model.h>
#include <pcl_floam/filters/core/sweep_motion.h>
#include <pcl_floam/filters/scan_lines.h>

#include <pcl/filters/filter.h>

#include <stdexcept>

namespace pcl_floam {

/// Re-expresses every point of a sweep at one instant of it, given the motion over the sweep (Eq. 3, 4 and 12).
///
/// The paper's stage 1 is this filter with the predicted motion log(T_{k-2}^-1 T_{k-1}) (Eq. 2), stage 2 the same
/// filter on the same input with the optimised motion log(T_{k-1}^-1 T_k) (Eq. 12a).
/// \code
/// pcl_floam::MotionCompensation<PointXYZIRT> compensation;
/// compensation.setInputCloud(sweep);
/// compensation.setMotion(start_T_end);   // the sensor's pose at the sweep's end, seen from its pose at the start
/// compensation.filter(undistorted);      // as seen from the sensor at the sweep's end
/// \endcode
/// Points keep their order and all their fields, also their time; normals are turned with the points. Points that
/// are not finite, or no returns (zero, or at the sensor), stay as they are. If no time can be told, or nothing moves,
/// the output is a copy of the input. With indices set, the output holds just those points, in their order; an index
/// that is none of the cloud's points makes `filter` throw std::invalid_argument.
template <typename PointT>
class MotionCompensation : public pcl::Filter<PointT> {
  using Base = pcl::Filter<PointT>;

public:
  using Ptr = pcl::shared_ptr<MotionCompensation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const MotionCompensation<PointT>>;
  using PointCloud = typename Base::PointCloud;

  MotionCompensation() { this->filter_name_ = "MotionCompensation"; }

  /// The motion over the sweep as a twist xi = log(start_T_end): metres, then radians. Default: none.
  /// \throws std::invalid_argument if it is not finite.
  void setTwist(const Vector6& twist)
  {
    if (!twist.allFinite()) {
      throw std::invalid_argument("motion compensation: the motion over the sweep is not finite");
    }
    twist_ = twist;
  }
  [[nodiscard]] const Vector6& getTwist() const { return twist_; }

  /// The change of the motion over the sweep. The twist is then the velocity at the sweep's middle, as the odometry's
  /// reports have both: `report.registration.sweep_twist` and `sweep_acceleration`. Default: none.
  /// \throws std::invalid_argument if it is not finite.
  void setAcceleration(const Vector6& acceleration)
  {
    if (!acceleration.allFinite()) {
      throw std::invalid_argument("motion compensation: the acceleration over the sweep is not finite");
    }
    acceleration_ = acceleration;
  }
  [[nodiscard]] const Vector6& getAcceleration() const { return acceleration_; }

  /// The motion over the sweep as the sensor's pose at its end, seen from its pose at the start.
  /// \throws std::invalid_argument if it is not finite.
  template <typename Transform>
  void setMotion(const Transform& start_T_end)
  {
    setTwist(log(SE3(start_T_end)));
  }
  [[nodiscard]] SE3 getMotion() const { return exp(twist_); }

  /// The instant from which the output is seen. Default: the sweep's end.
  void setReferenceInstant(PoseInstant instant) { instant_ = instant; }
  [[nodiscard]] PoseInstant getReferenceInstant() const { return instant_; }

  /// The sensor's beams, for clouds without times whose scan lines show the direction of rotation.
  void setSensor(const SensorModel& sensor) { sensor_ = sensor; }
  [[nodiscard]] const SensorModel& getSensor() const { return sensor_; }

  /// Where the sensor is in the frame of the clouds, if that is not its own but a vehicle's: scan lines
  /// and times that azimuths tell go by it. The motion is that of the clouds' frame.
  /// \throws std::invalid_argument for a pose that is not finite
  void setSensorPose(const SE3& frame_T_sensor) { sensor_pose_.set(frame_T_sensor); }
  [[nodiscard]] const SE3& getSensorPose() const { return sensor_pose_.get(); }

  /// Where the points' times are to come from. Default: automatic.
  void setScanTimingSource(ScanTimingSource source) { timing_source_ = source; }
  [[nodiscard]] ScanTimingSource getScanTimingSource() const { return timing_source_; }

  /// With which scan lines and times are found, where points have none; the result does not depend on it. 0 uses all
  /// processors. Default: 1.
  void setNumberOfThreads(unsigned int threads = 0) { threads_ = threadCount(threads); }
  [[nodiscard]] int getNumberOfThreads() const { return threads_; }

  /// The timing found by the last filter(). Of a cloud in a vehicle's frame
  /// it holds for the sensor's view of it (\ref SensorPose::ofSensor).
  [[nodiscard]] const ScanTiming& getScanTiming() const { return timing_; }

protected:
  void applyFilter(PointCloud& output) override;

private:
  Vector6 twist_ = Vector6::Zero();
  Vector6 acceleration_ = Vector6::Zero();
  PoseInstant instant_ = PoseInstant::end;
  SensorModel sensor_;
  SensorPose sensor_pose_;
  ScanTimingSource timing_source_ = ScanTimingSource::automatic;
  ScanTiming timing_;
  int threads_ = 1;
};

}  // namespace pcl_floam

#include <pcl_floam/filters/impl/motion_compensation.hpp>
