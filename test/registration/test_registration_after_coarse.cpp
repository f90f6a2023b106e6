// As the fine stage after PCL's registrations that need no guess, and before its bundle of all pairs.
#include "support/cloud_normals.h"
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/ppf.h>
#include <pcl/registration/ia_fpcs.h>
#include <pcl/registration/ia_ransac.h>
#include <pcl/registration/lum.h>
#include <pcl/registration/ppf_registration.h>

#include <gtest/gtest.h>

#include <cstdlib>

namespace pcl_floam::test {
namespace {

using NormalPoint = pcl::PointNormal;
using NormalCloud = pcl::PointCloud<NormalPoint>;

/// Far more than any registration finds that starts from nothing.
const Eigen::Matrix4f kFarMotion =
    motionThere(SE3(expSO3(2.6 * Eigen::Vector3d(0.3, 0.5, 0.8).normalized()), {1.5, -0.7, 0.4})).matrix<float>();

/// Every n-th point: searches without a guess go through all pairs of points.
NormalCloud::Ptr everyNth(const NormalCloud& cloud, std::size_t n)
{
  auto result = pcl::make_shared<NormalCloud>();
  for (std::size_t i = 0; i < cloud.size(); i += n) {
    result->push_back(cloud[i]);
  }
  return result;
}

/// Two samplings of the object, far apart. Their few points are for the coarse stage, all of them for ours.
class FineStage : public ::testing::Test {
protected:
  FineStage() : source(pcl::make_shared<NormalCloud>()), target(withNormals<NormalPoint>(sampledObject(1, 1.0)))
  {
    const Eigen::Matrix4f back = kFarMotion.inverse();
    pcl::transformPointCloudWithNormals(*withNormals<NormalPoint>(sampledObject(2, 1.0)), *source, back);
    few_of_source = everyNth(*source, 28);
    few_of_target = everyNth(*target, 28);
  }

  [[nodiscard]] double errorOf(const Eigen::Matrix4f& target_T_source) const
  {
    Cloud points;
    pcl::copyPointCloud(*source, points);
    return disagreement(points, target_T_source, kFarMotion);
  }

  [[nodiscard]] Eigen::Matrix4f refined(const Eigen::Matrix4f& guess) const
  {
    EdgePlaneRegistration<NormalPoint, NormalPoint> registration;
    registration.setInputSource(source);
    registration.setInputTarget(target);
    NormalCloud output;
    registration.align(output, guess);
    EXPECT_TRUE(registration.hasConverged());
    return registration.getFinalTransformation();
  }

  /// The coarse stage must have done its part and left ours something to do.
  void expectRefined(const Eigen::Matrix4f& coarse) const
  {
    EXPECT_LT(errorOf(coarse), 0.25);
    EXPECT_GT(errorOf(coarse), 0.005);
    EXPECT_LT(errorOf(refined(coarse)), 0.001);
  }

  NormalCloud::Ptr source;
  NormalCloud::Ptr target;
  NormalCloud::Ptr few_of_source;
  NormalCloud::Ptr few_of_target;
};

TEST_F(FineStage, NeedsTheCoarseOne)
{
  EXPECT_GT(errorOf(refined(Eigen::Matrix4f::Identity())), 0.1);
}

TEST_F(FineStage, AfterSampleConsensusInitialAlignment)
{
  const auto featuresOf = [](const NormalCloud::Ptr& few, const NormalCloud::Ptr& all) {
    pcl::FPFHEstimation<NormalPoint, NormalPoint, pcl::FPFHSignature33> estimation;
    estimation.setInputCloud(few);
    estimation.setSearchSurface(all);
    estimation.setInputNormals(all);
    estimation.setRadiusSearch(0.2);
    auto features = pcl::make_shared<pcl::PointCloud<pcl::FPFHSignature33>>();
    estimation.compute(*features);
    return features;
  };
  pcl::SampleConsensusInitialAlignment<NormalPoint, NormalPoint, pcl::FPFHSignature33> coarse;
  coarse.setInputSource(few_of_source);
  coarse.setSourceFeatures(featuresOf(few_of_source, everyNth(*source, 3)));
  coarse.setInputTarget(few_of_target);
  coarse.setTargetFeatures(featuresOf(few_of_target, everyNth(*target, 3)));
  coarse.setMinSampleDistance(0.3F);
  coarse.setMaxCorrespondenceDistance(0.1);
  coarse.setMaximumIterations(300);
  NormalCloud output;
  std::srand(1);
  coarse.align(output);
  expectRefined(coarse.getFinalTransformation());
}

TEST_F(FineStage, AfterPpfRegistration)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "PCL 1.13's PPFRegistration reads one number past the end of its votes";
#endif
  pcl::PPFEstimation<NormalPoint, NormalPoint, pcl::PPFSignature> estimation;
  estimation.setInputCloud(few_of_source);
  estimation.setInputNormals(few_of_source);
  auto features = pcl::make_shared<pcl::PointCloud<pcl::PPFSignature>>();
  estimation.compute(*features);
  auto search = pcl::make_shared<pcl::PPFHashMapSearch>(0.2F, 0.05F);
  search->setInputFeatureCloud(features);

  pcl::PPFRegistration<NormalPoint, NormalPoint> coarse;
  coarse.setSceneReferencePointSamplingRate(10);
  coarse.setPositionClusteringThreshold(0.2F);
  coarse.setRotationClusteringThreshold(0.5F);
  coarse.setSearchMethod(search);
  coarse.setInputSource(few_of_source);
  coarse.setInputTarget(few_of_target);
  NormalCloud output;
  coarse.align(output);
  expectRefined(coarse.getFinalTransformation());
}

/// Draws the same numbers in every run, where PCL's takes them from the time of day: without the first base, which is
/// drawn before anything here is asked.
class RepeatableFpcs : public pcl::registration::FPCSInitialAlignment<NormalPoint, NormalPoint, NormalPoint> {
protected:
  int bruteForceCorrespondences(int first, int second, pcl::Correspondences& pairs) override
  {
    if (!seeded_) {
      std::srand(1);
      seeded_ = true;
      return -1;
    }
    return FPCSInitialAlignment::bruteForceCorrespondences(first, second, pairs);
  }

private:
  bool seeded_ = false;
};

TEST_F(FineStage, AfterFourPointCongruentSets)
{
  RepeatableFpcs coarse;
  coarse.setInputSource(few_of_source);
  coarse.setInputTarget(few_of_target);
  coarse.setApproxOverlap(0.9F);
  coarse.setDelta(0.02F);
  coarse.setScoreThreshold(0.5F);
  coarse.setMaximumIterations(10);
  NormalCloud output;
  coarse.align(output);
  expectRefined(coarse.getFinalTransformation());
}

/// What a registration took for the same places when it ended.
pcl::CorrespondencesPtr correspondencesOf(const Cloud::Ptr& source, const Cloud::Ptr& target)
{
  EdgePlaneRegistration<Point, Point> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  auto correspondences = pcl::make_shared<pcl::Correspondences>();
  std::function<EdgePlaneRegistration<Point, Point>::UpdateVisualizerCallbackSignature> remember =
      [&](const Cloud&, const pcl::Indices& source_points, const Cloud&, const pcl::Indices& target_points) {
        correspondences->clear();
        for (std::size_t i = 0; i < source_points.size(); ++i) {
          correspondences->emplace_back(source_points[i], target_points[i], 0.0F);
        }
      };
  registration.registerVisualizationCallback(remember);
  Cloud output;
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
  return correspondences;
}

TEST(RegistrationComposition, CorrespondencesForLum)
{
  if (!farOff().isZero()) {
    GTEST_SKIP() << "LUM itself takes small angles about the origin for small ways";
  }
  pcl::registration::LUM<Point> lum;
  std::vector<Cloud::Ptr> clouds;
  std::vector<Eigen::Matrix4f> poses;
  for (int i = 0; i < 3; ++i) {
    poses.push_back(i == 0 ? Eigen::Matrix4f(Eigen::Matrix4f::Identity())
                           : Eigen::Matrix4f(motion(i == 1 ? 1.0 : -0.7)));
    clouds.push_back(pcl::make_shared<Cloud>());
    pcl::transformPointCloud(*sampledObject(static_cast<unsigned>(i + 1), 1.0), *clouds.back(),
                             Eigen::Matrix4f(poses.back().inverse()));
    lum.addPointCloud(clouds.back());
  }
  for (const auto& [source, target] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
    const auto s = static_cast<std::size_t>(source);
    const auto t = static_cast<std::size_t>(target);
    lum.setCorrespondences(s, t, correspondencesOf(clouds[s], clouds[t]));
  }
  lum.setMaxIterations(20);
  lum.compute();
  for (std::size_t i = 1; i < clouds.size(); ++i) {
    EXPECT_GT(disagreement(*clouds[i], Eigen::Matrix4f::Identity(), poses[i]), 0.04);
    EXPECT_LT(disagreement(*clouds[i], lum.getTransformation(i).matrix(), poses[i]), 0.002);
  }
}

}  // namespace
}  // namespace pcl_floam::test
