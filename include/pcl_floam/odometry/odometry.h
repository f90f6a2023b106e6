/// \file odometry.h
/// The paper's system: from one scan after another to a trajectory and a map.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/motion/motion_hint.h>
#include <pcl_floam/odometry/core/odometry_parameters.h>
#include <pcl_floam/odometry/core/odometry_report.h>
#include <pcl_floam/odometry/odometry_components.h>

#include <pcl/memory.h>
#include <pcl/point_cloud.h>

#include <cstdint>
#include <memory>
#include <optional>

namespace pcl_floam {

/// What becomes of a map that was made before.
enum class MapUse : std::uint8_t {
  frozen,       ///< it stays as it is: localisation whose error does not grow
  kept_current  ///< keyframes are added, by surfaces once it has explained half of a scan; what they see through, or is
                ///< beyond its horizon, is forgotten
};

/// The odometry for scans whose point type is known only at run time (\ref CloudView).
/// Most users want \ref Odometry.
///
/// One object per sensor. Objects share nothing but what \ref setComponents hands in, so each may be used by a thread
/// of its own; one object may be used by any thread, by one at a time. The getters, too, look at the state that \ref
/// track changes: they give no snapshot while another thread tracks. Whoever needs one copies the report, or the
/// odometry, between two scans. A copy goes on by itself from where the original is; what was moved from can only be
/// assigned to or destroyed.
class OdometryPipeline {
public:
  /// \throws std::invalid_argument if a parameter is out of its range.
  explicit OdometryPipeline(const OdometryParameters& parameters = {});
  OdometryPipeline(const OdometryPipeline& other);
  OdometryPipeline(OdometryPipeline&& other) noexcept;
  OdometryPipeline& operator=(const OdometryPipeline& other);
  OdometryPipeline& operator=(OdometryPipeline&& other) noexcept;
  ~OdometryPipeline();

  /// Takes the next scan. Never throws for data: the report tells what came of it.
  /// \param scan  one sweep in the sensor's frame, or that of \ref setSensorPose
  /// \param stamp seconds, any epoch, of the same instant of every sweep; without it scans are taken to
  ///              follow each other at a constant period. A scan that comes again with its stamp is not taken twice:
  ///              the report stays that of the first time, and says so
  const OdometryReport& track(const CloudView& scan, std::optional<double> stamp = std::nullopt);

  /// Tells that a scan is missing (unreadable, dropped): the pose moves on by prediction.
  const OdometryReport& trackMissing(std::optional<double> stamp = std::nullopt);

  /// What wheels, an IMU or another estimator tell of the motion to the scan that comes next (or is missing next):
  /// beside what the scans tell, and in place of it where these leave a direction open. It lasts for that one scan:
  /// give one before each. Along locked degrees of freedom it should say nothing: be of large variance.
  ///
  /// \throws std::invalid_argument as MotionHint::validate
  void setMotionHint(const MotionHint& hint);

  /// The sensor is at another place of the map than was thought: the next scan is sought there. Map and parameters
  /// stay; the velocity is found anew, and the next three scans do not enter the map that is registered with. Before
  /// the second scan it is the pose of the first. \ref getPose and \ref report tell of it from the next scan on.
  ///
  /// \param world_T_sensor of the next scan, within about 2 m and 10 degrees
  /// \throws std::invalid_argument for a pose that is not finite
  void setPose(const SE3& world_T_sensor);

  /// Where the sensor is in the frame that clouds are given in, where that is not its own: a vehicle's. From where a
  /// point was measured matters to scan lines, times, ranges and what is seen through. All poses, hints and the sweep's
  /// motion that are given and taken are then that frame's; what else `report().registration` tells, and what objects
  /// of one's own are told, is the sensor's. Forgets map and motion.
  ///
  /// \throws std::invalid_argument for a pose that is not finite, or that is turned where degrees of freedom are locked
  void setSensorPose(const SE3& frame_T_sensor);
  [[nodiscard]] const SE3& getSensorPose() const;

  /// Objects of one's own in place of the odometry's, or beside them. Forgets map and motion; \ref reset and
  /// \ref localizeIn keep them.
  ///
  /// \throws std::invalid_argument for a factor that is null, and for what the engine has no use for
  void setComponents(const OdometryComponents& components);
  [[nodiscard]] const OdometryComponents& getComponents() const;

  /// The last report.
  [[nodiscard]] const OdometryReport& report() const;

  /// `world_T_sensor` of the last scan, at the instant that the parameters name.
  [[nodiscard]] SE3 getPose() const;

  /// Edge and plane layer around the sensor.
  [[nodiscard]] const KeyframeVoxelMap& map() const;

  /// As they were given, but `threads`, which is the number that works, where all processors were asked for.
  [[nodiscard]] const OdometryParameters& getParameters() const;

  /// Forgets map and motion; the next scan starts at \p world_T_sensor.
  void reset(const SE3& world_T_sensor = {});

  /// Localises the scans that follow in a map made before, in place of building one. Forgets all else.
  /// \param map            as \ref loadMap or another odometry's \ref map give it; not empty
  /// \param world_T_sensor of the first scan, in the map's frame: within about 2 m and 10 degrees
  /// \throws std::invalid_argument for an empty map or a pose that is not finite.
  void localizeIn(KeyframeVoxelMap map, const SE3& world_T_sensor, MapUse use = MapUse::frozen);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// F-LOAM for scans of type \p PointT: any PCL point type with x, y, z.
///
/// \code
/// pcl_floam::Odometry<pcl::PointXYZI> odometry;
/// for (const auto& scan : scans) {
///   const auto& report = odometry.track(*scan);
///   std::cout << report.world_T_sensor.translation.transpose() << '\n';
/// }
/// \endcode
template <typename PointT>
class Odometry : public OdometryPipeline {
public:
  using Ptr = pcl::shared_ptr<Odometry<PointT>>;
  using ConstPtr = pcl::shared_ptr<const Odometry<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  using OdometryPipeline::OdometryPipeline;
  using OdometryPipeline::track;

  /// Takes the next scan; see OdometryPipeline::track.
  const OdometryReport& track(const PointCloud& scan, std::optional<double> stamp = std::nullopt)
  {
    return track(viewOf(scan), stamp);
  }
};

}  // namespace pcl_floam
