#include "map/kdtree_search.h"

#include <flann/flann.hpp>

#include <algorithm>

namespace pcl_floam {

using Tree = flann::KDTreeSingleIndex<flann::L2_3D<float>>;

struct KdTreeSearch::Index {
  Eigen::Vector3d origin =
      Eigen::Vector3d::Zero();     ///< of the single-precision coordinates: far from the world's own, near the points
  std::vector<float> coordinates;  ///< x y z of each point relative to the origin
  std::unique_ptr<Tree> tree;
};

namespace {

const flann::SearchParams kExact(flann::FLANN_CHECKS_UNLIMITED, 0.0F, true);

}  // namespace

KdTreeSearch::KdTreeSearch(const std::vector<Eigen::Vector3d>& points) : index_(std::make_unique<Index>())
{
  const auto first = std::find_if(points.begin(), points.end(), [](const auto& point) { return point.allFinite(); });
  if (first == points.end()) {
    return;
  }
  index_->origin = *first;
  index_->coordinates.reserve(3 * points.size());
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3f relative = (point - index_->origin).cast<float>();
    if (relative.allFinite()) {
      index_->coordinates.insert(index_->coordinates.end(), relative.data(), relative.data() + 3);
    }
  }
  index_->tree =
      std::make_unique<Tree>(flann::Matrix<float>(index_->coordinates.data(), index_->coordinates.size() / 3, 3),
                             flann::KDTreeSingleIndexParams(15));
  index_->tree->buildIndex();
}

KdTreeSearch::~KdTreeSearch() = default;

bool KdTreeSearch::empty() const
{
  return index_->tree == nullptr;
}

void KdTreeSearch::nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const
{
  neighbors.count = 0;
  if (!query.allFinite() || index_->tree == nullptr) {
    return;
  }
  Eigen::Vector3f relative = (query - index_->origin).cast<float>();
  const auto wanted = std::min(static_cast<std::size_t>(k), index_->coordinates.size() / 3);
  std::array<std::size_t, kMaxNeighbors> index;
  std::array<float, kMaxNeighbors> distance2;
  flann::Matrix<std::size_t> indices(index.data(), 1, wanted);
  flann::Matrix<float> distances(distance2.data(), 1, wanted);
  const int found =
      index_->tree->knnSearch(flann::Matrix<float>(relative.data(), 1, 3), indices, distances, wanted, kExact);
  const auto limit = static_cast<float>(radius * radius);
  for (std::size_t i = 0; i < static_cast<std::size_t>(found) && distance2[i] <= limit; ++i) {
    const Eigen::Vector3f point = Eigen::Map<const Eigen::Vector3f>(&index_->coordinates[3 * index[i]]);
    neighbors.neighbor[i] = {Eigen::Vector3f(point - relative), distance2[i]};
    ++neighbors.count;
  }
}

}  // namespace pcl_floam
