// The odometry's own map in a user's clothes, which counts what it is asked.
#pragma once

#include "map/voxel_pyramid.h"

#include <atomic>
#include <memory>
#include <utility>

namespace pcl_floam::test {

class CountingMap : public SurfaceMap {
public:
  /// Of all maps that are made from the first.
  struct Counts {
    std::atomic<int> places{0};  ///< looked up, or taken in
  };

  explicit CountingMap(std::shared_ptr<Counts> counts, double side = 1.0) : counts_(std::move(counts)), map_(side) {}

  [[nodiscard]] std::unique_ptr<SurfaceMap> makeEmpty(double side) const override
  {
    return std::make_unique<CountingMap>(counts_, side);
  }
  [[nodiscard]] std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<CountingMap>(*this); }
  [[nodiscard]] bool empty() const override { return map_.empty(); }
  void clear() override { map_.clear(); }
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) override
  {
    map_.insert(places, lasers, count);
    counts_->places += static_cast<int>(count);
  }
  void crop(const Eigen::Vector3d& center, double radius) override { map_.crop(center, radius); }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    map_.find(places, count, surfaces);
    counts_->places += static_cast<int>(count);
  }

private:
  std::shared_ptr<Counts> counts_;
  VoxelPyramid map_;
};

}  // namespace pcl_floam::test
