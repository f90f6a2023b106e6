// A sweep whose points have normals, of a type of one's own.
#define PCL_NO_PRECOMPILE
#include <pcl_floam/filters/motion_compensation.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {

/// A point with a normal and a time.
struct EIGEN_ALIGN16 PointNormalTime {
  PCL_ADD_POINT4D
  PCL_ADD_NORMAL4D
  float time = 0.0F;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace pcl_floam::test

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_floam::test::PointNormalTime,
                                  (float, x, x)(float, y, y)(float, z, z)(float, normal_x, normal_x)(
                                      float, normal_y, normal_y)(float, normal_z, normal_z)(float, time, time))

namespace pcl_floam::test {
namespace {

TEST(MotionCompensation, NormalsTurnWithThePoints)
{
  pcl::PointCloud<PointNormalTime> cloud(3, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    cloud[i].getVector3fMap() = Eigen::Vector3f(5.0F, 1.0F, 0.0F);
    cloud[i].getNormalVector3fMap() = Eigen::Vector3f(0.6F, 0.0F, 0.8F);
    cloud[i].time = 0.05F * static_cast<float>(i);
  }
  const Vector6 twist = (Vector6() << 1.2, -0.3, 0.1, 0.05, -0.04, 0.2).finished();
  MotionCompensation<PointNormalTime> compensation;
  compensation.setInputCloud(cloud.makeShared());
  compensation.setTwist(twist);
  pcl::PointCloud<PointNormalTime> output;
  compensation.filter(output);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Matrix3d end_R_point = exp(Vector6((0.5 * static_cast<double>(i) - 1.0) * twist)).rotation;
    const Eigen::Vector3d expected = end_R_point * Eigen::Vector3d(0.6, 0.0, 0.8);
    EXPECT_LT((output[i].getNormalVector3fMap().cast<double>() - expected).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace pcl_floam::test
