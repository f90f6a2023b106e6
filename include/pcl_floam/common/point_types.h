/// \file point_types.h
/// The point type of a rotating lidar: position, intensity, ring and time.
#pragma once

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

// PCL's macro has an anonymous struct in it, of which clang warns where the macro is used.
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wgnu-anonymous-struct"
#pragma clang diagnostic ignored "-Wnested-anon-types"
#endif

namespace pcl_floam {

/// A lidar return as most drivers publish it.
///
/// `x y z` in metres in the sensor's frame, `ring` the number of the laser (scan line), `time` in seconds
/// after the start of the sweep.
struct EIGEN_ALIGN16 PointXYZIRT {
  PCL_ADD_POINT4D
  float intensity = 0.0F;
  float time = 0.0F;
  std::uint16_t ring = 0;
  PCL_MAKE_ALIGNED_OPERATOR_NEW

  PointXYZIRT() : data{0.0F, 0.0F, 0.0F, 1.0F} {}
  PointXYZIRT(float px, float py, float pz, float i, std::uint16_t r, float t)
      : data{px, py, pz, 1.0F}, intensity(i), time(t), ring(r)
  {
  }
};

}  // namespace pcl_floam

#if defined(__clang__)
#pragma clang diagnostic pop
#endif

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_floam::PointXYZIRT,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity,
                                                                          intensity)(float, time, time)(std::uint16_t,
                                                                                                        ring, ring))
