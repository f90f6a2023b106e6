/// \file moved_cloud.h
/// A cloud of any point type in another frame.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/se3.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// What is nearer to the sensor is no return: its own place, as another frame's numbers round it. m
inline constexpr double kNoReturnWithin = 1e-4;

/// A copy of a cloud with x, y, z moved and all other fields as they are. Its memory is used again.
class MovedCloud {
public:
  /// \param target_T_source from the cloud's frame to the copy's
  /// \return the copy, until the next call or the object's end
  [[nodiscard]] CloudView take(const CloudView& cloud, const SE3& target_T_source);

private:
  std::vector<std::uint8_t> bytes_;
};

/// Where the sensor is in the frame that its clouds are given in, if that is not its own but a vehicle's.
class SensorPose {
public:
  /// \throws std::invalid_argument for a pose that is not finite
  void set(const SE3& frame_T_sensor);
  [[nodiscard]] const SE3& get() const { return frame_T_sensor_; }
  /// Whether clouds are given in the sensor's own frame.
  [[nodiscard]] bool isIdentity() const { return is_identity_; }

  /// Whether a point is no return: zero in the clouds' frame, or at the sensor. Filters leave it where it is.
  [[nodiscard]] bool isNoReturn(const Eigen::Vector3f& point) const
  {
    return point.isZero(0.0F) || (point.cast<double>() - frame_T_sensor_.translation).norm() < kNoReturnWithin;
  }

  /// The cloud as the sensor sees it; valid until the next call.
  [[nodiscard]] CloudView ofSensor(const CloudView& cloud)
  {
    return is_identity_ ? cloud : cloud_.take(cloud, frame_T_sensor_.inverse());
  }

private:
  SE3 frame_T_sensor_;
  bool is_identity_ = true;
  MovedCloud cloud_;
};

}  // namespace pcl_floam
