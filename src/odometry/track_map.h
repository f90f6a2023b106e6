/// \file track_map.h
/// What a track registers with.
#pragma once

#include "map/edge_lines.h"
#include "motion/sweep_pose.h"
#include "odometry/sweep.h"
#include "odometry/track_settings.h"

#include <memory>
#include <vector>

namespace pcl_floam {

/// Space (all points) and edges (the paper's features).
class TrackMap {
public:
  explicit TrackMap(const TrackSettings& settings);
  TrackMap(const TrackMap& other);
  TrackMap(TrackMap&& other) noexcept = default;
  TrackMap& operator=(const TrackMap& other);
  TrackMap& operator=(TrackMap&& other) noexcept = default;
  ~TrackMap() = default;

  void insert(const Sweep& sweep, const SweepPose& pose);

  /// As it began, but for its memory, which is used again.
  void clear();

  /// Takes in a map that many sweeps have made: no point of it is of one laser's pattern.
  void insert(const std::vector<Eigen::Vector3d>& space, const std::vector<Eigen::Vector3d>& edges);

  [[nodiscard]] const SurfaceSearch& space() const { return *space_; }
  [[nodiscard]] const SurfaceSearch& edges() const { return edges_; }

private:
  std::unique_ptr<SurfaceMap> space_;
  EdgeLines edges_;
  double horizon_;
};

}  // namespace pcl_floam
