// Lines and planes fitted to neighbours.
#include "registration/factors.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <Eigen/Eigenvalues>

namespace pcl_floam::test {
namespace {

Neighbors neighborsAt(const std::vector<Eigen::Vector3d>& offsets)
{
  Neighbors neighbors;
  for (const Eigen::Vector3d& offset : offsets) {
    Neighbor& neighbor = neighbors.neighbor[static_cast<std::size_t>(neighbors.count++)];
    neighbor.offset = offset.cast<float>();
    neighbor.squared_distance = neighbor.offset.squaredNorm();
  }
  return neighbors;
}

TEST(LineFit, FindsALine)
{
  std::mt19937 random(1);
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  const Eigen::Vector3d through(0.3, 0.1, -0.2);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 5; ++i) {
    points.push_back(through + (i - 2.0) * 0.2 * direction + randomTwist(random, 0.01, 0.0).head<3>());
  }
  const auto line = fitLine(neighborsAt(points));
  ASSERT_TRUE(line);
  EXPECT_NEAR(std::abs(line->direction.dot(direction)), 1.0, 1e-2);
  EXPECT_NEAR(line->direction.norm(), 1.0, 1e-9);
  EXPECT_LT((line->center - through).cross(direction).norm(), 0.02);
}

TEST(PlaneFit, FindsAPlane)
{
  std::mt19937 random(2);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1.0).normalized();
  const Eigen::Vector3d through(0.0, 0.2, 0.4);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 6; ++i) {
    Eigen::Vector3d offset(uniform(random, 1.0), uniform(random, 1.0), uniform(random, 1.0));
    offset -= normal * normal.dot(offset);
    points.push_back(through + offset);
  }
  const auto plane = fitPlane(neighborsAt(points));
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->direction.dot(normal)), 1.0, 1e-6);
  EXPECT_NEAR(normal.dot(plane->center - through), 0.0, 1e-6);
}

/// Points of a piece of surface somewhere, up to so thick.
std::vector<Eigen::Vector3d> patch(std::mt19937& random, int count, double thickness)
{
  const Eigen::Matrix3d axes = expSO3(randomTwist(random, 0.0, 2.0).tail<3>());
  const Eigen::Vector3d center = randomTwist(random, 1.0, 0.0).head<3>();
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d spread(uniform(random, 0.5), uniform(random, 0.2), uniform(random, thickness));
    points.push_back(center + axes * spread);
  }
  return points;
}

TEST(PlaneFit, IsThatOfTheEigenvectors)
{
  std::mt19937 random(9);
  int planes = 0;
  for (int n = 0; n < 2000; ++n) {
    const Neighbors neighbors = neighborsAt(patch(random, 5 + n % 4, n % 2 == 0 ? 0.01 : 0.05));
    Eigen::Matrix3Xd offsets(3, neighbors.count);
    for (int i = 0; i < neighbors.count; ++i) {
      offsets.col(i) = neighbors[i].offset.cast<double>();
    }
    const Eigen::Vector3d mean = offsets.rowwise().mean();
    offsets.colwise() -= mean;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(offsets * offsets.transpose() / neighbors.count);
    const Eigen::Vector3d& values = solver.eigenvalues();
    const auto plane = fitPlane(neighbors);
    if (!plane) {
      continue;
    }
    ++planes;
    EXPECT_NEAR(std::abs(plane->direction.dot(solver.eigenvectors().col(0))), 1.0, 1e-9);
    EXPECT_LT((plane->center - mean).norm(), 1e-12);
    double extrapolation = 1.0;
    Eigen::Matrix3d tilt = Eigen::Matrix3d::Zero();
    for (int axis = 1; axis < 3; ++axis) {
      const Eigen::Vector3d direction = solver.eigenvectors().col(axis);
      extrapolation += std::pow(direction.dot(mean), 2) / values[axis];
      tilt += values[0] / ((neighbors.count - 3) * values[axis]) * direction * direction.transpose();
    }
    EXPECT_NEAR(plane->variance, values[0] * extrapolation, 1e-6 * values[0] * extrapolation + 1e-12);
    const Eigen::Matrix3d told =
        plane->tilt[0] * plane->tilt[0].transpose() + plane->tilt[1] * plane->tilt[1].transpose();
    EXPECT_LT((told - tilt).norm(), 1e-6 * tilt.norm() + 1e-12);
  }
  EXPECT_GT(planes, 500);
}

TEST(PlaneFit, ItsVarianceIsTheScatterAcrossAndGrowsBeside)
{
  // Five points of a square with 1 m sides and its centre, two corners 3 cm above it, two below.
  const auto varianceAt = [](double aside) {
    std::vector<Eigen::Vector3d> points = {
        {0.5, 0.5, 0.03}, {-0.5, -0.5, 0.03}, {0.5, -0.5, -0.03}, {-0.5, 0.5, -0.03}, {0.0, 0.0, 0.0}};
    for (Eigen::Vector3d& point : points) {
      point.x() -= aside;
    }
    const auto plane = fitPlane(neighborsAt(points));
    return plane ? plane->variance : -1.0;
  };
  const double across = 4.0 * 0.03 * 0.03 / 5.0;
  const double along = 4.0 * 0.25 / 5.0;
  EXPECT_NEAR(varianceAt(0.0), across, 1e-6);
  EXPECT_NEAR(varianceAt(1.0), across * (1.0 + 1.0 / along), 1e-5);
}

TEST(PlaneFit, ItsTiltIsThatOfNormalsFittedToNoise)
{
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
  Eigen::Vector2d told = Eigen::Vector2d::Zero();
  for (int i = 0; i < 2000; ++i) {
    std::vector<Eigen::Vector3d> points;  // twice as long as wide
    for (const auto& [x, y] : {std::pair(0.2, 0.1), {0.2, -0.1}, {-0.2, 0.1}, {-0.2, -0.1}, {0.0, 0.0}}) {
      points.emplace_back(x, y, noise(random));
    }
    const auto plane = fitPlane(neighborsAt(points));
    if (plane) {
      const Eigen::Vector3d normal = plane->direction / plane->direction.z();
      seen += normal.head<2>().cwiseAbs2();
      told += plane->tilt[0].head<2>().cwiseAbs2() + plane->tilt[1].head<2>().cwiseAbs2();
    }
  }
  for (int axis = 0; axis < 2;
       ++axis) {  // two of five points' degrees of freedom are left, of which 1.5 make up for half
    EXPECT_GT(told[axis], 0.4 * seen[axis]) << axis;
    EXPECT_LT(told[axis], 1.2 * seen[axis]) << axis;
  }
}

TEST(LineFit, RefusesAPlane)
{
  EXPECT_FALSE(fitLine(neighborsAt({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 0}})));
}

TEST(PlaneFit, RefusesALine)
{
  // Any plane through the line would do: the normal is noise.
  EXPECT_FALSE(fitPlane(neighborsAt({{1, 0, 0}, {2, 0.001, 0}, {3, 0, 0}, {4, -0.001, 0}, {5, 0, 0}})));
}

TEST(PlaneFit, ALineGivesNoInfinities)
{
  std::mt19937 random(11);
  for (int n = 0; n < 1000; ++n) {
    const Eigen::Vector3d direction = randomTwist(random, 1.0, 0.0).head<3>();
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 5; ++i) {
      points.push_back((i - 2.3) * direction);
    }
    const auto plane = fitPlane(neighborsAt(points));
    if (plane) {  // by the coordinates' rounding
      EXPECT_TRUE(std::isfinite(plane->variance) && plane->tilt[0].allFinite() && plane->tilt[1].allFinite());
    }
  }
}

TEST(PlaneFit, RefusesABall)
{
  EXPECT_FALSE(fitPlane(neighborsAt({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})));
}

TEST(LinePlaneFit, RefuseOnePointManyTimes)
{
  const Neighbors same = neighborsAt({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  EXPECT_FALSE(fitLine(same));
  EXPECT_FALSE(fitPlane(same));
}

/// The ends of a slab's three axes.
Neighbors slab(double length, double width, double height)
{
  return neighborsAt({{length, 0, 0}, {-length, 0, 0}, {0, width, 0}, {0, -width, 0}, {0, 0, height}, {0, 0, -height}});
}

TEST(LineFit, IsOfWhatIsSeveralTimesAsLongAsWide)
{
  for (const double size : {0.01, 1.0, 10.0}) {  // m
    EXPECT_TRUE(fitLine(slab(4.0 * size, size, 0.5 * size))) << size;
    EXPECT_FALSE(fitLine(slab(1.5 * size, size, 0.5 * size))) << size;
    EXPECT_FALSE(fitLine(slab(size, size, size))) << size;
  }
}

TEST(PlaneFit, IsOfWhatIsThinAndNotNarrow)
{
  for (const double size : {0.01, 1.0, 10.0}) {  // m
    EXPECT_TRUE(fitPlane(slab(1.5 * size, size, 0.1 * size))) << size;
    EXPECT_TRUE(fitPlane(slab(4.0 * size, size, 0.1 * size))) << size << ": a kerb";
    EXPECT_FALSE(fitPlane(slab(1.5 * size, size, 0.5 * size))) << size << ": a block";
    EXPECT_FALSE(fitPlane(slab(20.0 * size, size, 0.01 * size))) << size << ": a wire";
  }
}

}  // namespace
}  // namespace pcl_floam::test
