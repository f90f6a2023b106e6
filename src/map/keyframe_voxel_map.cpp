#include <pcl_floam/map/keyframe_voxel_map.h>

#include "common/parameter_check.h"
#include "map/kdtree_search.h"
#include "map/voxel_layer.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace pcl_floam {

const char* toString(SearchMethod method)
{
  return method == SearchMethod::voxel ? "voxel" : "kdtree";
}

void validate(const MapParameters& p)
{
  const ParameterCheck check("map");
  check.above("voxel_size", p.voxel_size, 0.0);
  check.above("horizon", p.horizon, 0.0);
  check.atLeast("see_through_range", p.see_through_range, 0.0);
}

struct KeyframeVoxelMap::Impl {
  explicit Impl(const MapParameters& p) : parameters(p), edges(0.5 * p.voxel_size), planes(p.voxel_size) {}

  [[nodiscard]] VoxelLayer& layer(FeatureKind kind) { return kind == FeatureKind::edge ? edges : planes; }

  /// The trees are a picture of the layers at one moment: a change makes them new.
  void rebuildTrees()
  {
    if (parameters.search == SearchMethod::kdtree) {
      edge_tree = std::make_shared<KdTreeSearch>(edges.points());
      plane_tree = std::make_shared<KdTreeSearch>(planes.points());
    }
  }

  void insert(VoxelLayer& layer_of_kind, const std::vector<Feature>& features, const SE3& world_T_sensor, int threads)
  {
    points.resize(features.size());
    intensities.resize(features.size());
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t i = 0; i < features.size(); ++i) {
      points[i] = world_T_sensor * Eigen::Vector3d(features[i].x, features[i].y, features[i].z);
      intensities[i] = features[i].intensity;
    }
    layer_of_kind.insertEach(points.data(), points.size(), threads, intensities.data());
  }

  /// Cropping touches every block, so it is done once the sensor has gone a tenth of the horizon.
  void crop(const Eigen::Vector3d& center)
  {
    edges.crop(center, parameters.horizon);
    planes.crop(center, parameters.horizon);
    last_crop = center;
  }

  MapParameters parameters;
  VoxelLayer edges;
  VoxelLayer planes;
  Eigen::Vector3d last_crop = Eigen::Vector3d::Zero();
  std::shared_ptr<const KdTreeSearch> edge_tree;  // shared: a copy of the map may look at the same picture
  std::shared_ptr<const KdTreeSearch> plane_tree;

  // Of the last keyframe: their memory is used again.
  std::vector<Eigen::Vector3d> points;
  std::vector<float> intensities;
  RangeImage scan;
};

KeyframeVoxelMap::KeyframeVoxelMap(const MapParameters& parameters)
{
  validate(parameters);
  impl_ = std::make_unique<Impl>(parameters);
  impl_->rebuildTrees();
}

KeyframeVoxelMap::KeyframeVoxelMap(const KeyframeVoxelMap& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
KeyframeVoxelMap::KeyframeVoxelMap(KeyframeVoxelMap&& other) noexcept = default;
KeyframeVoxelMap& KeyframeVoxelMap::operator=(KeyframeVoxelMap&& other) noexcept = default;
KeyframeVoxelMap::~KeyframeVoxelMap() = default;

KeyframeVoxelMap& KeyframeVoxelMap::operator=(const KeyframeVoxelMap& other)
{
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}

void KeyframeVoxelMap::insert(const FeatureSet& features, const SE3& world_T_sensor, int threads)
{
  impl_->insert(impl_->edges, features.edges, world_T_sensor, threads);
  impl_->insert(impl_->planes, features.planes, world_T_sensor, threads);
  if ((world_T_sensor.translation - impl_->last_crop).norm() > 0.1 * impl_->parameters.horizon) {
    impl_->crop(world_T_sensor.translation);
  }
  impl_->rebuildTrees();
}

void KeyframeVoxelMap::insertPoints(FeatureKind kind, const std::vector<Eigen::Vector3d>& points,
                                    const std::vector<float>& intensities)
{
  if (!intensities.empty() && intensities.size() != points.size()) {
    throw std::invalid_argument("KeyframeVoxelMap::insertPoints: not as many intensities as points");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) {
      const bool has_intensity = !intensities.empty() && std::isfinite(intensities[i]);
      impl_->layer(kind).insertMean(points[i], has_intensity ? intensities[i] : 0.0F);
    }
  }
  impl_->rebuildTrees();
}

void KeyframeVoxelMap::forgetSeenThrough(const std::vector<Eigen::Vector3f>& points, const SE3& world_T_sensor,
                                         int threads)
{
  const double range = impl_->parameters.see_through_range;
  if (range > 0.0) {
    RangeImage& scan = impl_->scan;
    scan.take(points);
    const std::size_t forgotten = impl_->edges.weakenSeenThrough(scan, world_T_sensor, range, threads) +
                                  impl_->planes.weakenSeenThrough(scan, world_T_sensor, range, threads);
    if (forgotten > 0) {
      impl_->rebuildTrees();
    }
  }
}

void KeyframeVoxelMap::crop(const Eigen::Vector3d& center)
{
  impl_->crop(center);
  impl_->rebuildTrees();
}

void KeyframeVoxelMap::clear()
{
  impl_->edges.clear();
  impl_->planes.clear();
  impl_->rebuildTrees();
}

std::size_t KeyframeVoxelMap::size(FeatureKind kind) const
{
  return impl_->layer(kind).size();
}

const NeighborSearch& KeyframeVoxelMap::search(FeatureKind kind) const
{
  if (impl_->parameters.search == SearchMethod::kdtree) {
    return kind == FeatureKind::edge ? *impl_->edge_tree : *impl_->plane_tree;
  }
  return impl_->layer(kind);
}

std::vector<Eigen::Vector3d> KeyframeVoxelMap::points(FeatureKind kind) const
{
  return impl_->layer(kind).points();
}

std::vector<float> KeyframeVoxelMap::intensities(FeatureKind kind) const
{
  return impl_->layer(kind).intensities();
}

const MapParameters& KeyframeVoxelMap::getParameters() const
{
  return impl_->parameters;
}

}  // namespace pcl_floam
