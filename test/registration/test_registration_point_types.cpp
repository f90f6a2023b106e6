// Every point type, also one of the user's own; built with and without PCL_NO_PRECOMPILE.
#include "support/registration_clouds.h"

#include <pcl_floam/common/point_types.h>
#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

#ifdef PCL_NO_PRECOMPILE
#include <pcl/filters/impl/filter.hpp>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/search/impl/kdtree.hpp>

/// A type that PCL has never heard of.
struct SurveyPoint {
  PCL_ADD_POINT4D;
  float reflectance = 0.0F;
  std::uint32_t station = 0;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

POINT_CLOUD_REGISTER_POINT_STRUCT(SurveyPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, reflectance,
                                                                          reflectance)(std::uint32_t, station, station))
#endif

namespace pcl_floam::test {
namespace {

template <typename PointT>
class RegistrationPointTypes : public testing::Test {
};

#ifdef PCL_NO_PRECOMPILE
using Types = testing::Types<pcl::PointXYZI, PointXYZIRT, SurveyPoint>;
#else
using Types = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointXYZRGBA, pcl::PointNormal,
                             pcl::PointXYZINormal, pcl::PointXYZRGBNormal>;
#endif
TYPED_TEST_SUITE(RegistrationPointTypes, Types);

template <typename PointT, typename Scalar>
void registerObject()
{
  auto source = pcl::make_shared<pcl::PointCloud<PointT>>();
  auto target = pcl::make_shared<pcl::PointCloud<PointT>>();
  Cloud away;
  pcl::transformPointCloud(*sampledObject(2, 1.0), away, Eigen::Matrix4f(motion(1.0).inverse()));
  for (const Point& point : away) {
    PointT p;
    p.getVector3fMap() = point.getVector3fMap();
    source->push_back(p);
  }
  const auto object = sampledObject(1, 1.0);
  for (const Point& point : *object) {
    PointT p;
    p.getVector3fMap() = point.getVector3fMap();
    target->push_back(p);
  }
  EdgePlaneRegistration<PointT, PointT, Scalar> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  pcl::PointCloud<PointT> output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_LT(disagreement(away, registration.getFinalTransformation().template cast<float>(), motion(1.0)), 0.001);
  EXPECT_LT(registration.getFitnessScore(), 0.001);
}

TYPED_TEST(RegistrationPointTypes, RegisterInSinglePrecision)
{
  registerObject<TypeParam, float>();
}

TEST(RegistrationPrecision, PointTypesRegisterInDoublePrecision)
{
  registerObject<pcl::PointXYZ, double>();
  registerObject<pcl::PointXYZINormal, double>();
#ifdef PCL_NO_PRECOMPILE
  registerObject<SurveyPoint, double>();
#endif
}

TEST(RegistrationOutput, NormalsAreTurnedAndOtherFieldsCarried)
{
  using PointN = pcl::PointXYZINormal;
  auto source = pcl::make_shared<pcl::PointCloud<PointN>>();
  Cloud away;
  pcl::transformPointCloud(*sampledObject(2, 1.0), away, Eigen::Matrix4f(motion(1.0).inverse()));
  for (const Point& point : away) {
    PointN p;
    p.getVector3fMap() = point.getVector3fMap();
    p.getNormalVector3fMap() = Eigen::Vector3f::UnitX();
    p.intensity = static_cast<float>(source->size());
    p.curvature = 0.25F;
    source->push_back(p);
  }
  auto target = pcl::make_shared<pcl::PointCloud<PointN>>();
  pcl::copyPointCloud(*sampledObject(1, 1.0), *target);
  EdgePlaneRegistration<PointN, PointN> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  pcl::PointCloud<PointN> output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  const Eigen::Vector3f turned = registration.getFinalTransformation().topLeftCorner<3, 3>().col(0);
  EXPECT_GT((turned - Eigen::Vector3f::UnitX()).norm(), 0.01F);
  for (std::size_t i = 0; i < output.size(); ++i) {
    EXPECT_LT((output[i].getNormalVector3fMap() - turned).norm(), 1e-6F);
    EXPECT_EQ(output[i].intensity, static_cast<float>(i));
    EXPECT_EQ(output[i].curvature, 0.25F);
  }
}

}  // namespace
}  // namespace pcl_floam::test
