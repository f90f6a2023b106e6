// Local smoothness (Eq. 1).
#include "filters/smoothness.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

LinePoints lineOf(const std::vector<Eigen::Vector3d>& points)
{
  LinePoints line;
  for (const Eigen::Vector3d& point : points) {
    line.x.push_back(static_cast<float>(point.x()));
    line.y.push_back(static_cast<float>(point.y()));
    line.z.push_back(static_cast<float>(point.z()));
    line.range.push_back(static_cast<float>(point.norm()));
  }
  return line;
}

std::vector<float> smoothness(const std::vector<Eigen::Vector3d>& points, int half_window, SmoothnessKind kind)
{
  std::vector<float> sigma;
  computeSmoothness(lineOf(points), half_window, kind, sigma);
  return sigma;
}

std::vector<Eigen::Vector3d> randomPoints(int count)
{
  std::mt19937 random(1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(uniform(random, 5.0), uniform(random, 5.0), uniform(random, 5.0));
  }
  return points;
}

TEST(Smoothness, IsZeroOnALineWithTheVectorSum)
{
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) {
    points.push_back(Eigen::Vector3d(3.0, -1.0, 0.5) + 0.1 * i * Eigen::Vector3d(0.6, 0.8, 0.0));
  }
  for (int n = 5; n < 35; ++n) {
    EXPECT_NEAR(smoothness(points, 5, SmoothnessKind::vector_sum)[static_cast<std::size_t>(n)], 0.0F, 1e-5F);
    // As printed it is the mean distance to the neighbours: 0.1 m (1 + ... + 5) / 5
    EXPECT_NEAR(smoothness(points, 5, SmoothnessKind::mean_of_norms)[static_cast<std::size_t>(n)], 0.3F, 1e-5F);
  }
}

TEST(Smoothness, AgreesWithBruteForce)
{
  const auto points = randomPoints(50);
  for (const int half_window : {2, 5, 10}) {
    const auto vector_sum = smoothness(points, half_window, SmoothnessKind::vector_sum);
    const auto mean_of_norms = smoothness(points, half_window, SmoothnessKind::mean_of_norms);
    for (int n = 0; n < 50; ++n) {
      const auto center = static_cast<std::size_t>(n);
      if (n < half_window || n >= 50 - half_window) {
        EXPECT_TRUE(std::isnan(vector_sum[center]));
        EXPECT_TRUE(std::isnan(mean_of_norms[center]));
        continue;
      }
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double norms = 0.0;
      for (int j = n - half_window; j <= n + half_window; ++j) {
        sum += points[static_cast<std::size_t>(j)] - points[center];
        norms += (points[static_cast<std::size_t>(j)] - points[center]).norm();
      }
      EXPECT_NEAR(vector_sum[center], sum.norm() / (2.0 * half_window), 1e-5);
      EXPECT_NEAR(mean_of_norms[center], norms / (2.0 * half_window), 1e-5);
    }
  }
}

TEST(Smoothness, DoesNotDependOnThePlaceOfTheSensor)
{
  const SE3 motion = exp((Vector6() << 3.0, -2.0, 1.0, 0.5, 0.2, -1.0).finished());
  const auto points = randomPoints(50);
  auto moved = points;
  for (Eigen::Vector3d& point : moved) {
    point = motion * point;
  }
  for (const SmoothnessKind kind : {SmoothnessKind::vector_sum, SmoothnessKind::mean_of_norms}) {
    const auto before = smoothness(points, 5, kind);
    const auto after = smoothness(moved, 5, kind);
    for (std::size_t n = 5; n < 45; ++n) {
      EXPECT_NEAR(before[n], after[n], 1e-5F);
    }
  }
}

TEST(Smoothness, ShortLinesHaveNone)
{
  for (const int count : {0, 1, 10}) {
    const auto sigma = smoothness(randomPoints(count), 5, SmoothnessKind::vector_sum);
    EXPECT_EQ(sigma.size(), static_cast<std::size_t>(count));
    for (const float value : sigma) {
      EXPECT_TRUE(std::isnan(value));
    }
  }
}

TEST(Smoothness, AcrossIsZeroOnALineHoweverItsPointsAreSpaced)
{
  std::mt19937 random(2);
  std::vector<Eigen::Vector3d> points;
  double along = 0.0;
  for (int i = 0; i < 40; ++i) {
    along += 0.05 + std::abs(uniform(random, 1.0));
    points.push_back(Eigen::Vector3d(3.0, -1.0, 0.5) + along * Eigen::Vector3d(0.6, 0.8, 0.0));
  }
  std::vector<float> across;
  computeSmoothnessAcross(lineOf(points), 2, across);
  const std::vector<float> whole = smoothness(points, 2, SmoothnessKind::vector_sum);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const bool has_neighbors = n >= 2 && n < points.size() - 2;
    EXPECT_EQ(std::isnan(across[n]), !has_neighbors) << n;
    if (has_neighbors) {
      EXPECT_NEAR(across[n], 0.0F, 1e-5F);
    }
  }
  EXPECT_GT(*std::max_element(whole.begin() + 2, whole.end() - 2), 0.1F);
}

TEST(Smoothness, AcrossIsTheWholeAtACornerOfEvenPoints)
{
  std::vector<Eigen::Vector3d> points;
  for (int i = -5; i <= 5; ++i) {
    points.emplace_back(3.0 + 0.1 * std::min(i, 0), 2.0 + 0.1 * std::max(i, 0), 0.0);
  }
  std::vector<float> across;
  computeSmoothnessAcross(lineOf(points), 5, across);
  const float whole = smoothness(points, 5, SmoothnessKind::vector_sum)[5];
  EXPECT_GT(whole, 0.1F);
  EXPECT_NEAR(across[5], whole, 1e-6F);
}

TEST(Smoothness, AcrossIsUnknownInLinesThatAreTooShort)
{
  std::vector<float> across;
  computeSmoothnessAcross(lineOf(randomPoints(4)), 2, across);
  EXPECT_EQ(across.size(), 4U);
  EXPECT_TRUE(std::all_of(across.begin(), across.end(), [](float sigma) { return std::isnan(sigma); }));
}

}  // namespace
}  // namespace pcl_floam::test
