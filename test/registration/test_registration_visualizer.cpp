// Watched by PCL's visualizer of registrations, without a window.
#include "support/object_pair.h"

#include <pcl/visualization/registration_visualizer.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Visualizer = pcl::RegistrationVisualizer<Point, Point>;

/// What the visualizer would draw is private: an explicit instantiation may name it all the same.
template <auto Cloud, auto SourcePoints, auto TargetPoints>
struct Drawn {
  friend const pcl::PointCloud<Point>& drawnCloud(const Visualizer& visualizer) { return visualizer.*Cloud; }
  friend const pcl::Indices& drawnSourcePoints(const Visualizer& visualizer) { return visualizer.*SourcePoints; }
  friend const pcl::Indices& drawnTargetPoints(const Visualizer& visualizer) { return visualizer.*TargetPoints; }
};
const pcl::PointCloud<Point>& drawnCloud(const Visualizer& visualizer);
const pcl::Indices& drawnSourcePoints(const Visualizer& visualizer);
const pcl::Indices& drawnTargetPoints(const Visualizer& visualizer);
template struct Drawn<&Visualizer::cloud_intermediate_, &Visualizer::cloud_intermediate_indices_,
                      &Visualizer::cloud_target_indices_>;

TEST(RegistrationComposition, RegistrationVisualizer)
{
  ObjectPair pair;
  Visualizer visualizer;
  ASSERT_TRUE(visualizer.setRegistration(pair.registration));
  EXPECT_LT(pair.align(), 0.001);

  // The last it was told: the source where it ended, and pairs of points that lie close together.
  const pcl::PointCloud<Point>& cloud = drawnCloud(visualizer);
  const pcl::Indices& source_points = drawnSourcePoints(visualizer);
  const pcl::Indices& target_points = drawnTargetPoints(visualizer);
  ASSERT_EQ(cloud.size(), pair.source->size());
  ASSERT_EQ(source_points.size(), target_points.size());
  ASSERT_GT(source_points.size(), cloud.size() / 2);
  for (std::size_t i = 0; i < source_points.size(); ++i) {
    const Point& a = cloud.at(static_cast<std::size_t>(source_points[i]));
    const Point& b = pair.target->at(static_cast<std::size_t>(target_points[i]));
    ASSERT_LT((a.getVector3fMap() - b.getVector3fMap()).norm(), 0.1);
  }
  EXPECT_LT((cloud[0].getVector3fMap() - pair.output[0].getVector3fMap()).norm(), 0.001);
}

}  // namespace
}  // namespace pcl_floam::test
