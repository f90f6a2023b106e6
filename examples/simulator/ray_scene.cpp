#include "ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pcl_floam::simulator {

namespace {

/// A mesh as a scene of its own, to be placed in the world as an instance.
RTCScene makeScene(RTCDevice device, const TriangleMesh& mesh)
{
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                           mesh.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), mesh.triangles.size());
  std::copy_n(mesh.vertices.data(), mesh.vertices.size(), static_cast<std::array<float, 3>*>(vertices));
  std::copy_n(mesh.triangles.data(), mesh.triangles.size(), static_cast<std::array<std::uint32_t, 3>*>(triangles));
  rtcCommitGeometry(geometry);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

/// Embree's own order of a pose: the columns of the rotation, then the translation.
std::array<float, 12> columnsOf(const SE3& pose)
{
  std::array<float, 12> columns{};
  Eigen::Map<Eigen::Matrix<float, 3, 4>> matrix(columns.data());
  matrix.leftCols<3>() = pose.rotation.cast<float>();
  matrix.col(3) = pose.translation.cast<float>();
  return columns;
}

}  // namespace

struct RayScene::Implementation {
  /// One object in the world.
  struct Instance {
    RTCScene shape = nullptr;
    RTCGeometry geometry = nullptr;
    std::vector<float> reflectivity, gloss;
    Eigen::Matrix3f object_R_world = Eigen::Matrix3f::Identity();  ///< turns rays as the normals are
    bool moving = false;
  };

  RTCDevice device = nullptr;
  RTCScene world = nullptr;
  std::vector<Instance> instances;

  /// \param time_steps 1 for what stands still, 2 for what moves during a sweep
  void add(const TriangleMesh& mesh, unsigned int time_steps)
  {
    Instance instance;
    instance.shape = makeScene(device, mesh);
    instance.geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance.geometry, instance.shape);
    rtcSetGeometryTimeStepCount(instance.geometry, time_steps);
    instance.reflectivity = mesh.reflectivity;
    instance.gloss = mesh.gloss;
    instance.moving = time_steps > 1;
    rtcAttachGeometryByID(world, instance.geometry, static_cast<unsigned int>(instances.size()));
    instances.push_back(instance);
  }
};

RayScene::RayScene(const TriangleMesh& still) : implementation_(std::make_unique<Implementation>())
{
  // One thread: building a tree in parallel could change which of two touching triangles is met.
  implementation_->device = rtcNewDevice("threads=1");
  if (implementation_->device == nullptr) {
    throw std::runtime_error("Embree cannot be started");
  }
  implementation_->world = rtcNewScene(implementation_->device);
  rtcSetSceneFlags(implementation_->world, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  implementation_->add(still, 1);
  rtcCommitGeometry(implementation_->instances.front().geometry);
}

RayScene::~RayScene()
{
  rtcReleaseScene(implementation_->world);
  for (const Implementation::Instance& instance : implementation_->instances) {
    rtcReleaseGeometry(instance.geometry);
    rtcReleaseScene(instance.shape);
  }
  rtcReleaseDevice(implementation_->device);
}

void RayScene::addMoving(const TriangleMesh& shape)
{
  implementation_->add(shape, 2);
  place(implementation_->instances.size() - 2, SE3(), SE3());
}

void RayScene::place(std::size_t object, const SE3& world_T_start, const SE3& world_T_end)
{
  Implementation::Instance& instance =
      implementation_->instances[object + 1];  // the first one is all that stands still
  rtcSetGeometryTransform(instance.geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columnsOf(world_T_start).data());
  rtcSetGeometryTransform(instance.geometry, 1, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columnsOf(world_T_end).data());
  rtcCommitGeometry(instance.geometry);
  instance.object_R_world = world_T_start.rotation.transpose().cast<float>();
}

void RayScene::commit()
{
  rtcCommitScene(implementation_->world);
}

RayHit RayScene::cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float max_range,
                      float fraction) const
{
  RTCRayHit query{};
  query.ray.org_x = origin.x();
  query.ray.org_y = origin.y();
  query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tfar = max_range;
  query.ray.time = fraction;
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(implementation_->world, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return {};
  }
  const Implementation::Instance& instance = implementation_->instances[query.hit.instID[0]];
  const Eigen::Vector3f normal = Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  const float cosine = std::abs(normal.dot(instance.object_R_world * direction));
  const float gloss = query.hit.primID < instance.gloss.size() ? instance.gloss[query.hit.primID] : 0.0F;
  return {query.ray.tfar,
          cosine,
          instance.reflectivity[query.hit.primID],
          gloss,
          instance.object_R_world.transpose() * normal,
          instance.moving};
}

}  // namespace pcl_floam::simulator
