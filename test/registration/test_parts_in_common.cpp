// Clouds of which only a part is in both, or some of whose points come again and again.
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/search/kdtree.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point, double>;

constexpr double kWidth = 2.0;    // m, half of the room's
constexpr double kNoise = 0.005;  // m

/// Where the room is: seen from its own middle it would be taken for a lidar's scan.
Eigen::Vector3d there()
{
  return farOff() + Eigen::Vector3d(10.0, 5.0, 0.0);
}

/// A place on a block that stands on the floor.
Eigen::Vector3d placeOnBlock(std::mt19937& random)
{
  Eigen::Vector3d place = randomVector(random, 1.0);
  const auto face = static_cast<Eigen::Index>(random() % 3);
  place[face] = place[face] < 0.0 && face != 2 ? -1.0 : 1.0;
  return Eigen::Vector3d(0.3, 0.6, 0.35) + place.cwiseProduct(Eigen::Vector3d(0.4, 0.5, 0.35));
}

/// A place on the floor of a room, on three of its walls or on one of the things in it.
Eigen::Vector3d placeInRoom(std::mt19937& random)
{
  const double u = uniform(random, kWidth);
  const double v = uniform(random, kWidth);
  const double height = 1.25 + uniform(random, 1.25);
  const double angle = uniform(random, kPi);
  switch (random() % 6) {
    case 0: return {u, v, 0.0};
    case 1: return {u, kWidth, height};
    case 2: return {-kWidth, u, height};
    case 3: return {kWidth, u, height};
    case 4: return {0.15 * std::cos(angle) - 0.3, 0.15 * std::sin(angle) - 1.2, 0.5 * height};
    default: return placeOnBlock(random);
  }
}

/// What lies between two distances along the room, in another frame.
Cloud::Ptr partOfRoom(unsigned seed, double from, double to, const SE3& frame_T_room)
{
  constexpr std::size_t kPoints = 8000;
  std::mt19937 random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  while (cloud->size() < kPoints) {
    const Eigen::Vector3d place = placeInRoom(random);
    const Eigen::Vector3d error(uniform(random, kNoise), uniform(random, kNoise), uniform(random, kNoise));
    if (place.x() >= from && place.x() <= to) {
      Point point;
      point.getVector3fMap() = (frame_T_room * (place + error) + there()).cast<float>();
      cloud->push_back(point);
    }
  }
  return cloud;
}

Registration::Ptr registered(const Cloud::Ptr& source, const Cloud::Ptr& target)
{
  auto registration = pcl::make_shared<Registration>();
  registration->setInputSource(source);
  registration->setInputTarget(target);
  Cloud output;
  registration->align(output);
  return registration;
}

}  // namespace

/// Some six, or less than five, tenths of each are in the other one. Coarse pictures of the two look most alike where
/// each fills the other.
TEST(PartsInCommon, AreFoundFromAGoodGuess)
{
  for (unsigned seed = 21; seed < 36; ++seed) {
    const double part = 2.0 * kWidth / (seed < 24 ? 1.4 : 1.55);
    std::mt19937 random(seed);
    Vector6 off;
    off << 0.08 * randomVector(random, 1.0).normalized(), 0.07 * randomVector(random, 1.0).normalized();
    const SE3 room_T_target = exp(off);
    const Cloud::Ptr source = partOfRoom(10 * seed, -kWidth, -kWidth + part, SE3());
    const Cloud::Ptr target = partOfRoom(10 * seed + 1, kWidth - part, kWidth, room_T_target.inverse());
    const Registration::Ptr registration = registered(source, target);
    ASSERT_TRUE(registration->hasConverged());
    const Eigen::Matrix4d truth = SE3(Eigen::Matrix3d::Identity(), there()).matrix() *
                                  room_T_target.inverse().matrix() *
                                  SE3(Eigen::Matrix3d::Identity(), -there()).matrix();
    EXPECT_LT(disagreement(*source, registration->getFinalTransformation().cast<float>(), truth.cast<float>()), 0.01)
        << seed;
  }
}

/// A point that is there thirty thousand times is one place.
TEST(RepeatedPoints, TellNothingMore)
{
  const Cloud::Ptr source = partOfRoom(5, -kWidth, kWidth, SE3());
  const Cloud::Ptr target =
      partOfRoom(6, -kWidth, kWidth, exp((Vector6() << 0.05, 0.03, 0.0, 0.0, 0.0, 0.04).finished()));
  const Registration::Ptr once = registered(source, target);
  auto repeating = pcl::make_shared<Cloud>(*source);
  auto target_repeating = pcl::make_shared<Cloud>(*target);
  for (int i = 0; i < 30000; ++i) {
    repeating->push_back((*source)[5]);
    target_repeating->push_back((*target)[7]);
  }
  const Registration::Ptr again = registered(repeating, target_repeating);
  EXPECT_EQ(again->getFinalTransformation(), once->getFinalTransformation());
  EXPECT_EQ(again->report().covariance, once->report().covariance);
}

/// A tree of the user's knows all points, and may answer with any of those that are the same.
class SecondOfEach : public pcl::search::KdTree<Point> {
public:
  using pcl::search::KdTree<Point>::nearestKSearch;

  int nearestKSearch(const Point& point, int k, pcl::Indices& indices, std::vector<float>& squares) const override
  {
    const int found = pcl::search::KdTree<Point>::nearestKSearch(point, k, indices, squares);
    const auto half = static_cast<int>(this->getInputCloud()->size() / 2);
    for (auto& index : indices) {
      index += index < half ? half : 0;
    }
    return found;
  }
};

TEST(RepeatedPoints, MayBeWhatASearchFinds)
{
  const Cloud::Ptr source = partOfRoom(5, -kWidth, kWidth, SE3());
  const SE3 motion = exp((Vector6() << 0.05, 0.03, 0.0, 0.0, 0.0, 0.04).finished());
  const Cloud::Ptr target = partOfRoom(6, -kWidth, kWidth, motion);
  auto twice = pcl::make_shared<Cloud>(*target);
  *twice += *target;
  auto tree = pcl::make_shared<SecondOfEach>();
  tree->setInputCloud(twice);
  Registration registration;
  registration.setSearchMethodTarget(tree, true);
  registration.setInputSource(source);
  registration.setInputTarget(twice);
  Cloud output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  const Eigen::Matrix4d without = registered(source, target)->getFinalTransformation();
  const Eigen::Matrix4f with = registration.getFinalTransformation().cast<float>();
  EXPECT_LT(disagreement(*source, with, without.cast<float>()), 0.002);
}

}  // namespace pcl_floam::test
