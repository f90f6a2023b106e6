/// \file registration_clouds.h
/// Clouds to register, from a lidar and not.
#pragma once

#include "support/random_motion.h"
#include "support/synthetic_cloud.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdlib>

namespace pcl_floam::test {

using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;

/// How far the objects' places are moved off: each test runs once near the origin and once many objects' sizes from it.
inline Eigen::Vector3d farOff()
{
  return std::getenv("PCL_FLOAM_TEST_FAR_OFF") != nullptr ? Eigen::Vector3d(40.0, -25.0, 10.0)
                                                          : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// A motion of the objects, wherever they are.
inline SE3 motionThere(const SE3& motion, double scale = 1.0)
{
  const SE3 there(Eigen::Matrix3d::Identity(), scale * farOff());
  return there * motion * there.inverse();
}

/// A scan of the room from a place, in firing order, without rings; the intensity is the point's number.
inline Cloud::Ptr scanFrom(const SE3& world_T_sensor)
{
  auto cloud = pcl::make_shared<Cloud>();
  for (const Return& r : sweepRoom(Room(), Lidar(), world_T_sensor)) {
    Point point;
    point.getVector3fMap() = r.point.cast<float>();
    point.intensity = static_cast<float>(cloud->size());
    cloud->push_back(point);
  }
  return cloud;
}

/// Points on a box with a half cylinder on its top and a fin, about 1 m across: no lidar took it.
inline Cloud::Ptr sampledObject(unsigned seed, double scale, int points = 6000)
{
  std::mt19937 random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < points; ++i) {
    const double u = uniform(random, 0.5);
    const double v = uniform(random, 0.5);
    Eigen::Vector3d p;
    switch (i % 5) {
      case 0: p = {u, v, -0.2}; break;
      case 1: p = {u, 0.5, 0.4 * v}; break;
      case 2: p = {-0.5, u, 0.4 * v}; break;
      case 3: p = {u, 0.3 * std::cos(kPi * (v + 0.5)), 0.2 + 0.3 * std::sin(kPi * (v + 0.5))}; break;
      default: p = {0.1 + 0.3 * u, 0.6 * u + 0.1, 0.6 + 0.4 * v}; break;
    }
    Point point;
    point.getVector3fMap() = (scale * (p + Eigen::Vector3d(2.0, 1.0, 0.5) + farOff())).cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

inline Eigen::Matrix4f motion(double scale)
{
  const Vector6 twist = (Vector6() << 0.06 * scale, -0.04 * scale, 0.03 * scale, 0.03, -0.02, 0.04).finished();
  return motionThere(exp(twist), scale).matrix<float>();
}

/// Root mean square distance between a cloud moved by two transforms.
inline double disagreement(const Cloud& cloud, const Eigen::Matrix4f& a, const Eigen::Matrix4f& b)
{
  double sum = 0.0;
  for (const Point& point : cloud) {
    const Eigen::Vector4f p(point.x, point.y, point.z, 1.0F);
    sum += static_cast<double>(((a - b) * p).squaredNorm());
  }
  return std::sqrt(sum / static_cast<double>(cloud.size()));
}

/// Where the second scan of the room is taken.
inline const SE3 kOther = exp((Vector6() << 0.5, -0.3, 0.05, 0.01, -0.02, 0.08).finished());

}  // namespace pcl_floam::test
