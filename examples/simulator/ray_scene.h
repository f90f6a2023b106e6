/// \file ray_scene.h
/// Which surface a laser beam meets first: Embree, seen from the simulator.
#pragma once

#include "triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <memory>

namespace pcl_floam::simulator {

/// What a ray meets.
struct RayHit {
  float distance = std::numeric_limits<float>::infinity();  ///< m; infinite if it meets nothing
  float incidence_cosine = 0.0F;  ///< |cosine| of the angle between the ray and the surface's normal
  float reflectivity = 0.0F;
  float gloss = 0.0F;                                ///< see TriangleMesh::gloss
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the surface, in the world's frame; of either sign
  bool moving = false;                               ///< the surface belongs to a moving object

  [[nodiscard]] bool exists() const { return distance < std::numeric_limits<float>::infinity(); }
};

/// Still surfaces and moving objects, intersected by rays.
///
/// Single precision inside: at 300 m from the origin positions are good to 0.03 mm, a thousandth of the range noise.
class RayScene {
public:
  /// \throws std::runtime_error if Embree cannot be started
  explicit RayScene(const TriangleMesh& still);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Adds a moving object; its number is the count of objects before it.
  void addMoving(const TriangleMesh& shape);

  /// Places an object for the next sweep: where it is at the sweep's start and at its end. Between the two its pose
  /// changes evenly (Embree's motion blur), so that moving objects are distorted by the sweep as well.
  void place(std::size_t object, const SE3& world_T_start, const SE3& world_T_end);

  /// To be called after objects were placed and before rays are cast.
  void commit();

  /// \param fraction of the sweep at which the ray is sent, in [0,1]
  /// \param direction of length 1
  [[nodiscard]] RayHit cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float max_range,
                            float fraction) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pcl_floam::simulator
