#include <pcl_floam/common/core/moved_cloud.h>

#include <stdexcept>

namespace pcl_floam {

CloudView MovedCloud::take(const CloudView& cloud, const SE3& target_T_source)
{
  bytes_.assign(cloud.data, cloud.data + cloud.size * cloud.stride);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const Eigen::Vector3d point(cloud.x(i), cloud.y(i), cloud.z(i));
    if (point.isZero(0.0)) {
      continue;  // no return, whatever the frame
    }
    Eigen::Vector3f there = (target_T_source * point).cast<float>();
    if (there.cast<double>().norm() < kNoReturnWithin) {
      there.setZero();
    }
    std::uint8_t* bytes = bytes_.data() + i * cloud.stride;
    std::memcpy(bytes + cloud.x_offset, &there.x(), sizeof(float));
    std::memcpy(bytes + cloud.y_offset, &there.y(), sizeof(float));
    std::memcpy(bytes + cloud.z_offset, &there.z(), sizeof(float));
  }
  CloudView moved = cloud;
  moved.data = bytes_.data();
  return moved;
}

void SensorPose::set(const SE3& frame_T_sensor)
{
  if (!frame_T_sensor.isFinite()) {
    throw std::invalid_argument("the sensor's pose in its clouds' frame is not finite");
  }
  frame_T_sensor_ = frame_T_sensor;
  is_identity_ = frame_T_sensor.rotation.isIdentity(0.0) && frame_T_sensor.translation.isZero(0.0);
}

}  // namespace pcl_floam
