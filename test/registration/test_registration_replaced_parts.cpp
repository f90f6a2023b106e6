// Search objects and estimations of the user's own, and a guess that is no rigid motion.
#include "support/cloud_normals.h"
#include "support/object_pair.h"

#include <pcl/registration/transformation_estimation_svd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Of PCL's tutorial "How to incrementally register pairs of clouds".
class WithCurvature : public pcl::PointRepresentation<pcl::PointNormal> {
public:
  WithCurvature() { nr_dimensions_ = 4; }
  void copyToFloatArray(const pcl::PointNormal& point, float* out) const override
  {
    std::copy_n(point.data, 3, out);
    out[3] = point.curvature;
  }
};

TEST(RegistrationReplacedParts, ThePairwiseTutorialEndsWhereItShould)
{
  using CloudN = pcl::PointCloud<pcl::PointNormal>;
  const ObjectPair pair;
  const auto target = withNormals<pcl::PointNormal>(pair.target);
  auto source = withNormals<pcl::PointNormal>(pair.source);
  auto representation = pcl::make_shared<WithCurvature>();
  const float alpha[4] = {1.0F, 1.0F, 1.0F, 1.0F};
  representation->setRescaleValues(alpha);
  EdgePlaneRegistration<pcl::PointNormal, pcl::PointNormal> registration;
  registration.setTransformationEpsilon(1e-6);
  registration.setMaxCorrespondenceDistance(0.1);
  registration.setPointRepresentation(representation);
  registration.setInputTarget(target);
  registration.setMaximumIterations(2);
  Eigen::Matrix4f total = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f last = Eigen::Matrix4f::Zero();
  for (int i = 0; i < 30; ++i) {
    registration.setInputSource(source);
    const auto moved = pcl::make_shared<CloudN>();
    registration.align(*moved);
    ASSERT_TRUE(registration.hasConverged()) << i;
    source = moved;
    total = registration.getFinalTransformation() * total;
    if (std::abs((registration.getLastIncrementalTransformation() - last).sum()) <
        registration.getTransformationEpsilon()) {
      registration.setMaxCorrespondenceDistance(registration.getMaxCorrespondenceDistance() - 0.001);
    }
    last = registration.getLastIncrementalTransformation();
  }
  EXPECT_LT(disagreement(*pair.source, total, motion(1.0)), 0.005);
}

/// Tells points of different normals apart, as a registration has turned them.
class WithNormal : public pcl::PointRepresentation<pcl::PointNormal> {
public:
  WithNormal() { nr_dimensions_ = 6; }
  void copyToFloatArray(const pcl::PointNormal& point, float* out) const override
  {
    std::copy_n(point.data, 3, out);
    std::copy_n(point.data_n, 3, out + 3);
  }
};

TEST(RegistrationReplacedParts, ARepresentationSeesTurnedNormals)
{
  const ObjectPair pair;
  const auto target = withNormals<pcl::PointNormal>(pair.target);
  const auto source = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  const Eigen::Matrix4f quarter =
      motionThere(SE3(expSO3(0.5 * kPi * Eigen::Vector3d::UnitZ()), Eigen::Vector3d::Zero())).matrix<float>();
  pcl::transformPointCloudWithNormals(*target, *source, Eigen::Matrix4f(quarter.inverse()));
  EdgePlaneRegistration<pcl::PointNormal, pcl::PointNormal> registration;
  registration.setPointRepresentation(pcl::make_shared<const WithNormal>());
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setMaximumIterations(1);  // else thinned clouds would do the work
  pcl::PointCloud<pcl::PointNormal> output;
  registration.align(output, quarter);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_LT(disagreement(*pair.target, registration.getFinalTransformation() * quarter.inverse(),
                         Eigen::Matrix4f::Identity()),
            1e-4);
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
  EXPECT_GT(setup.registration.report().covariance.diagonal().minCoeff(), 1e3);  // of which nothing is known
  EXPECT_EQ(setup.registration.report().weak_directions.size(), 6U);
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

TEST(RegistrationReplacedParts, AGuessThatIsAlmostRigidIsRegisteredByShapes)
{
  // A turn of 25 degrees by its sine and cosine, whose cosine is wrong in the third digit.
  ObjectPair setup;
  SE3 turn(expSO3(25.0 / 180.0 * kPi * Eigen::Vector3d::UnitZ()), Eigen::Vector3d::Zero());
  turn.rotation(0, 0) = turn.rotation(1, 1) = 0.904;
  const SE3 object(Eigen::Matrix3d::Identity(), Eigen::Vector3d(2.0, 1.0, 0.5) + farOff());
  const Eigen::Matrix4f guess = (object * turn * object.inverse()).matrix<float>();
  setup.registration.align(setup.output, guess);
  ASSERT_TRUE(setup.registration.hasConverged());
  EXPECT_LT(disagreement(*setup.source, setup.registration.getFinalTransformation(), motion(1.0)), 0.005);
  EXPECT_GT(setup.registration.report().plane_correspondences, 1000);
}

/// The tree within PCL's search is protected: an explicit instantiation may name it all the same.
template <auto Tree>
struct Inside {
  friend bool hasTree(pcl::search::KdTree<Point>& search) { return (search.*Tree)->getInputCloud() != nullptr; }
};
bool hasTree(pcl::search::KdTree<Point>& search);
template struct Inside<&pcl::search::KdTree<Point>::tree_>;

TEST(RegistrationReplacedParts, TheTargetsTreeIsMadeWhenItIsAsked)
{
  ObjectPair setup;
  EXPECT_LT(setup.align(), 0.005);
  const auto search = setup.registration.getSearchMethodTarget();
  EXPECT_FALSE(hasTree(*search));
  EXPECT_EQ(search->getInputCloud(), setup.target);
  const double score = setup.registration.getFitnessScore();
  EXPECT_LT(score, 0.01);
  EXPECT_TRUE(hasTree(*search));
  const auto elsewhere = pcl::make_shared<Cloud>(*setup.target);
  for (Point& point : *elsewhere) {
    point.x += 10.0F;
  }
  setup.registration.setInputTarget(elsewhere);
  EXPECT_FALSE(hasTree(*search));
  EXPECT_GT(setup.registration.getFitnessScore(), 10.0);
  setup.registration.setInputTarget(elsewhere);
  search->setInputCloud(setup.target);  // the user's last word
  EXPECT_NEAR(setup.registration.getFitnessScore(), score, 0.5 * score);
}

}  // namespace
}  // namespace pcl_floam::test
