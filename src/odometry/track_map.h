/// \file track_map.h
/// What a track registers with.
#pragma once

#include "map/edge_lines.h"
#include "motion/sweep_pose.h"
#include "odometry/sweep.h"
#include "odometry/track_settings.h"

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace pcl_floam {

/// Maps that nobody needs any more, for those who need one: the memory of a map takes longer to get than a sweep to
/// register.
class SpareMaps {
public:
  struct Map {
    std::unique_ptr<SurfaceMap> space;
    EdgeLines edges;
  };

  /// Empty; nothing if there is none.
  [[nodiscard]] std::optional<Map> take();
  void give(Map map);

private:
  std::mutex mutex_;
  std::vector<Map> maps_;
};

/// Space (all points) and edges (the paper's features).
class TrackMap {
public:
  explicit TrackMap(const TrackSettings& settings);
  TrackMap(const TrackMap& other);
  TrackMap(TrackMap&& other) noexcept = default;
  TrackMap& operator=(TrackMap other) noexcept;
  ~TrackMap();

  void insert(const Sweep& sweep, const SweepPose& pose);

  /// From the next sweep on, what lies farther from the sensor (m) is forgotten.
  void keepWithin(double horizon) { horizon_ = horizon; }

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
  std::weak_ptr<SpareMaps> spare_;  // where it goes in the end
};

}  // namespace pcl_floam
