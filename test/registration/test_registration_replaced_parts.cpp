// Search objects and estimations of the user's own, and a guess that is no rigid motion.
#include "support/object_pair.h"

#include <pcl/registration/transformation_estimation_svd.h>

#include <gtest/gtest.h>

#include <limits>

namespace pcl_floam::test {
namespace {

TEST(RegistrationReplacedParts, ASearchObjectNotToBeRecomputedIsUsedAsItIs)
{
  ObjectPair setup;
  auto tree = pcl::make_shared<pcl::search::KdTree<Point>>();
  auto few = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < 3000; ++i) {
    few->push_back(2 * i);
  }
  tree->setInputCloud(setup.target, few);
  setup.registration.setSearchMethodTarget(tree, true);
  const auto counter = pcl::make_shared<Halving>();
  setup.registration.addCorrespondenceRejector(counter);
  setup.registration.setMaximumIterations(3);
  setup.align();
  ASSERT_FALSE(counter->seen.empty());
  for (const pcl::Correspondence& match : counter->seen.back()) {
    EXPECT_EQ(match.index_match % 2, 0);
  }
  EXPECT_EQ(tree->getIndices(), pcl::IndicesConstPtr(few));
}

/// Counts that it is called.
class CountingEstimation : public pcl::registration::TransformationEstimationSVD<Point, Point, float> {
public:
  void estimateRigidTransformation(const Cloud& source, const Cloud& target, const pcl::Correspondences& matches,
                                   Matrix4& transformation) const override
  {
    ++calls;
    TransformationEstimationSVD::estimateRigidTransformation(source, target, matches, transformation);
  }

  mutable int calls = 0;
};

TEST(RegistrationReplacedParts, AReplacedEstimationTakesOver)
{
  ObjectPair setup;
  const auto estimation = pcl::make_shared<CountingEstimation>();
  setup.registration.setTransformationEstimation(estimation);
  setup.registration.setTransformationEpsilon(1e-10);
  (*setup.source)[3].x = std::numeric_limits<float>::quiet_NaN();  // which ends the process in ICP itself
  setup.source->is_dense = false;
  setup.registration.align(setup.output);
  EXPECT_LT(disagreement(*sampledObject(2, 1.0), setup.registration.getFinalTransformation(), motion(1.0)), 0.05);
  EXPECT_GT(estimation->calls, 1);
  EXPECT_EQ(setup.registration.report().iterations, estimation->calls);
}

TEST(RegistrationReplacedParts, AGuessThatScalesIsCarriedAlong)
{
  ObjectPair setup;
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  guess.topLeftCorner<3, 3>() *= 1.1F;
  setup.registration.align(setup.output, guess);
  EXPECT_TRUE(setup.registration.hasConverged());
  const Eigen::Matrix3f linear = setup.registration.getFinalTransformation().topLeftCorner<3, 3>();
  EXPECT_NEAR(linear.determinant(), 1.331F, 1e-3F);
}

}  // namespace
}  // namespace pcl_floam::test
