// ICP's settings: rejectors, callback, criteria, reciprocal matches.
#include "support/object_pair.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/registration/correspondence_rejection_distance.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/correspondence_rejection_trimmed.h>
#include <pcl/registration/correspondence_rejection_var_trimmed.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point>;
using Criteria = pcl::registration::DefaultConvergenceCriteria<float>;

TEST(RegistrationSettings, RejectorsSeeSquaredDistancesOfPointsInEachIteration)
{
  ObjectPair setup;
  setup.registration.setMaximumIterations(3);  // none on thinned clouds
  const auto first = pcl::make_shared<Halving>();
  const auto second = pcl::make_shared<Halving>();
  setup.registration.addCorrespondenceRejector(first);
  setup.registration.addCorrespondenceRejector(second);
  setup.align();
  ASSERT_EQ(first->seen.size(), static_cast<std::size_t>(setup.registration.report().iterations));
  ASSERT_EQ(second->seen.size(), first->seen.size());
  EXPECT_EQ(second->seen[0].size(), (first->seen[0].size() + 1) / 2);
  for (const pcl::Correspondence& match : first->seen[0]) {
    const float squared = ((*setup.source)[static_cast<std::size_t>(match.index_query)].getVector3fMap() -
                           (*setup.target)[static_cast<std::size_t>(match.index_match)].getVector3fMap())
                              .squaredNorm();
    EXPECT_NEAR(match.distance, squared, 1e-6F);
  }
  const RegistrationReport& report = setup.registration.report();
  EXPECT_EQ(report.edge_correspondences + report.plane_correspondences + report.point_correspondences,
            static_cast<int>((second->seen.back().size() + 1) / 2));
}

TEST(RegistrationSettings, PclsRejectorsWork)
{
  ObjectPair setup;
  const auto trimmed = pcl::make_shared<pcl::registration::CorrespondenceRejectorTrimmed>();
  trimmed->setOverlapRatio(0.7F);
  setup.registration.addCorrespondenceRejector(trimmed);
  EXPECT_LT(setup.align(), 0.005);
  EXPECT_TRUE(setup.registration.hasConverged());
}

TEST(RegistrationSettings, ARejectorByTheSpreadOfDistancesBearsThatThereIsNone)
{
  // It keeps what is nearer than the spread, of which exact copies have none.
  ObjectPair setup;
  pcl::transformPointCloud(*setup.target, *setup.source, Eigen::Matrix4f(motion(1.0).inverse()));
  setup.registration.addCorrespondenceRejector(pcl::make_shared<pcl::registration::CorrespondenceRejectorVarTrimmed>());
  EXPECT_LT(setup.align(), 1e-4);
  EXPECT_TRUE(setup.registration.hasConverged());
  setup.registration.setInputSource(setup.target);
  setup.registration.align(setup.output);
  EXPECT_TRUE(setup.registration.hasConverged());
}

TEST(RegistrationSettings, ARejectorThatRefusesAllPreventsConvergence)
{
  ObjectPair setup;
  const auto distance = pcl::make_shared<pcl::registration::CorrespondenceRejectorDistance>();
  distance->setMaximumDistance(1e-7F);
  setup.registration.addCorrespondenceRejector(distance);
  setup.align();
  EXPECT_FALSE(setup.registration.hasConverged());
  EXPECT_EQ(setup.registration.report().termination, Termination::too_few_correspondences);
  EXPECT_EQ(setup.registration.getConvergeCriteria()->getConvergenceState(),
            Criteria::CONVERGENCE_CRITERIA_NO_CORRESPONDENCES);
  EXPECT_EQ(setup.registration.getFinalTransformation(), Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  setup.registration.clearCorrespondenceRejectors();
  EXPECT_LT(setup.align(), 0.005);
  EXPECT_TRUE(setup.registration.hasConverged());
}

TEST(RegistrationSettings, RejectorsByNormalsGetNormals)
{
  using PointN = pcl::PointNormal;
  auto cloud = pcl::make_shared<pcl::PointCloud<PointN>>();
  pcl::copyPointCloud(*sampledObject(1, 1.0), *cloud);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*cloud)[i].getNormalVector3fMap() = i % 2 == 0 ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitZ();
  }
  EdgePlaneRegistration<PointN, PointN> registration;
  const auto rejector = pcl::make_shared<pcl::registration::CorrespondenceRejectorSurfaceNormal>();
  rejector->initializeDataContainer<pcl::PointXYZ, pcl::Normal>();  // the types in which PCL hands it the clouds
  rejector->setThreshold(0.9);
  registration.addCorrespondenceRejector(rejector);
  registration.setInputSource(cloud);
  registration.setInputTarget(cloud);
  pcl::PointCloud<PointN> output;
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
}

TEST(RegistrationSettings, TheCallbackComesOnceAnIteration)
{
  ObjectPair setup;
  int calls = 0;
  Cloud last;
  std::function<Registration::UpdateVisualizerCallbackSignature> callback =
      [&](const Cloud& moved, const pcl::Indices& from, const Cloud& target, const pcl::Indices& to) {
        ++calls;
        last = moved;
        EXPECT_EQ(from.size(), to.size());
        EXPECT_EQ(target.size(), setup.target->size());
        EXPECT_EQ(from.empty(), calls == 1);
      };
  ASSERT_TRUE(setup.registration.registerVisualizationCallback(callback));
  EXPECT_EQ(calls, 1);  // PCL's own, when it is registered
  setup.align();
  EXPECT_EQ(calls - 1, setup.registration.report().iterations);
  EXPECT_LT((last[10].getVector3fMap() - setup.output[10].getVector3fMap()).norm(), 1e-5F);
}

TEST(RegistrationSettings, TheCallbackComesForScansToo)
{
  Registration registration;
  const auto source = scanFrom(kOther);
  registration.setInputSource(source);
  registration.setInputTarget(scanFrom(SE3()));
  int calls = 0;
  std::function<Registration::UpdateVisualizerCallbackSignature> callback =
      [&](const Cloud&, const pcl::Indices&, const Cloud&, const pcl::Indices&) { ++calls; };
  registration.registerVisualizationCallback(callback);
  Cloud output;
  registration.align(output);
  EXPECT_EQ(calls - 1, registration.report().iterations);
}

TEST(RegistrationSettings, CriteriaTellWhyItEnded)
{
  ObjectPair setup;
  setup.align();
  EXPECT_EQ(setup.registration.getConvergeCriteria()->getConvergenceState(), Criteria::CONVERGENCE_CRITERIA_TRANSFORM);
  setup.registration.setMaximumIterations(2);
  setup.align();
  EXPECT_TRUE(setup.registration.hasConverged());
  EXPECT_EQ(setup.registration.report().termination, Termination::iteration_limit);
  EXPECT_EQ(setup.registration.getConvergeCriteria()->getConvergenceState(), Criteria::CONVERGENCE_CRITERIA_ITERATIONS);
  setup.registration.getConvergeCriteria()->setFailureAfterMaximumIterations(true);
  setup.align();
  EXPECT_FALSE(setup.registration.hasConverged());
  EXPECT_EQ(setup.registration.getConvergeCriteria()->getConvergenceState(),
            Criteria::CONVERGENCE_CRITERIA_FAILURE_AFTER_MAX_ITERATIONS);
}

TEST(RegistrationSettings, ZeroIterationsAreOne)
{
  ObjectPair setup;
  setup.registration.setMaximumIterations(0);
  setup.align();
  EXPECT_TRUE(setup.registration.hasConverged());
  EXPECT_EQ(setup.registration.report().iterations, 1);
}

TEST(RegistrationSettings, EpsilonsEndItSoonerOrLater)
{
  ObjectPair setup;
  setup.align();
  const int usual = setup.registration.report().iterations;
  setup.registration.setTransformationEpsilon(1e-2);  // 0.1 m
  setup.registration.setTransformationRotationEpsilon(0.9);
  setup.align();
  EXPECT_LT(setup.registration.report().iterations, usual);
  EXPECT_EQ(setup.registration.report().termination, Termination::converged);
  setup.registration.setTransformationEpsilon(1e-14);
  setup.registration.setTransformationRotationEpsilon(0.0);
  setup.align();
  EXPECT_GE(setup.registration.report().iterations, usual);
}

TEST(RegistrationSettings, TheLastRegistrationsErrorDoesNotEndTheNext)
{
  // A mean squared error that does not change ends it, but not between two registrations.
  ObjectPair setup;
  setup.registration.setTransformationEpsilon(1e-14);
  setup.align();
  const int iterations = setup.registration.report().iterations;
  ASSERT_GT(iterations, 1);
  const Eigen::Matrix4f result = setup.registration.getFinalTransformation();
  for (int i = 0; i < 3; ++i) {
    setup.align();
    EXPECT_EQ(setup.registration.report().iterations, iterations);
    EXPECT_EQ(setup.registration.getFinalTransformation(), result);
  }
}

TEST(RegistrationSettings, TheFitnessEpsilonIsRelative)
{
  ObjectPair setup;
  setup.align();
  const int usual = setup.registration.report().iterations;
  setup.registration.setEuclideanFitnessEpsilon(0.9);
  setup.align();
  EXPECT_LT(setup.registration.report().iterations, usual);
  EXPECT_EQ(setup.registration.getConvergeCriteria()->getConvergenceState(), Criteria::CONVERGENCE_CRITERIA_REL_MSE);
}

TEST(RegistrationSettings, ReciprocalMatchesAreFewerAndGood)
{
  ObjectPair setup;
  setup.align();
  const auto matches = [&] {
    const RegistrationReport& report = setup.registration.report();
    return report.edge_correspondences + report.plane_correspondences + report.point_correspondences;
  };
  const int all = matches();
  setup.registration.setUseReciprocalCorrespondences(true);
  EXPECT_TRUE(setup.registration.getUseReciprocalCorrespondences());
  EXPECT_LT(setup.align(), 0.005);
  EXPECT_LT(matches(), 9 * all / 10);
  EXPECT_GT(matches(), all / 3);
}

TEST(RegistrationSettings, TheMaximumDistanceHolds)
{
  ObjectPair setup;
  const auto counter = pcl::make_shared<Halving>();
  setup.registration.addCorrespondenceRejector(counter);
  setup.registration.setMaxCorrespondenceDistance(0.02);
  setup.align();
  ASSERT_FALSE(counter->seen.empty());
  for (const auto& matches : counter->seen) {
    for (const pcl::Correspondence& match : matches) {
      EXPECT_LE(match.distance, 0.02F * 0.02F * 1.0001F);
    }
  }
}

TEST(RegistrationSettings, LockedDegreesOfFreedomKeepTheGuess)
{
  const Eigen::Matrix4f guess =
      motionThere(exp((Vector6() << 0.01, 0.01, 0.02, 0.01, 0.01, 0.0).finished())).matrix<float>();
  ObjectPair setup;
  RegistrationParameters parameters;
  parameters.locked = kPlanarMotion;
  setup.registration.setParameters(parameters);
  setup.registration.align(setup.output, guess);
  ASSERT_TRUE(setup.registration.hasConverged());
  const Eigen::Matrix4f planar = setup.registration.getFinalTransformation();
  EXPECT_NEAR(planar(2, 3), guess(2, 3), 1e-5F);
  EXPECT_LT((planar.block<1, 3>(2, 0) - guess.block<1, 3>(2, 0)).norm(), 1e-6F);
  EXPECT_GT((planar - guess).norm(), 0.01F);
  const Matrix6 covariance = setup.registration.report().covariance;
  for (const int i : {2, 3, 4}) {
    EXPECT_EQ(covariance.row(i).norm(), 0.0);
  }
  EXPECT_GT(covariance(0, 0), 0.0);

  parameters.locked = {true, true, true, false, false, false};
  setup.registration.setParameters(parameters);
  setup.registration.align(setup.output, guess);
  ASSERT_TRUE(setup.registration.hasConverged());
  const Eigen::Matrix4f change = setup.registration.getFinalTransformation() - guess;
  EXPECT_LT(change.col(3).norm(), 1e-5F);
  EXPECT_GT(change.leftCols<3>().norm(), 1e-3F);

  parameters.locked.fill(true);
  setup.registration.setParameters(parameters);
  setup.registration.align(setup.output, guess);
  EXPECT_LT((setup.registration.getFinalTransformation() - guess).norm(), 1e-5F);
}

TEST(RegistrationSettings, TheNumberOfIterationsSetByIcpsSetterStays)
{
  ObjectPair setup;
  setup.registration.setMaximumIterations(1);
  setup.registration.setParameters(RegistrationParameters());
  setup.align();
  EXPECT_EQ(setup.registration.report().iterations, 1);
}

TEST(RegistrationSettings, TheLastIncrementIsTheLastStep)
{
  ObjectPair setup;
  setup.registration.setMaximumIterations(1);
  setup.align();
  EXPECT_LT(
      (setup.registration.getLastIncrementalTransformation() - setup.registration.getFinalTransformation()).norm(),
      1e-6F);
  setup.registration.setMaximumIterations(30);
  setup.align();
  const Eigen::Matrix4f last = setup.registration.getLastIncrementalTransformation();
  EXPECT_LT((last - Eigen::Matrix4f::Identity()).norm(), 1e-3F);
  EXPECT_EQ(last.row(3), Eigen::RowVector4f(0.0F, 0.0F, 0.0F, 1.0F));
}

}  // namespace
}  // namespace pcl_floam::test
