/// \file edge_plane_registration.h
/// The pose estimation as a PCL registration.
#pragma once

#include <pcl_floam/filters/feature_extractor.h>
#include <pcl_floam/filters/sensor_model.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/feature_registration.h>

#include <pcl/registration/icp.h>

#include <memory>
#include <optional>

namespace pcl_floam {

/// Registers a cloud with another cloud or with a map by point-to-line and point-to-plane distances (the paper's
/// "Pose Estimation"), in place of `pcl::IterativeClosestPoint`.
///
/// \code
/// pcl_floam::EdgePlaneRegistration<pcl::PointXYZI, pcl::PointXYZI> registration;
/// registration.setInputSource(scan);
/// registration.setInputTarget(other_scan);
/// registration.align(aligned);
/// if (registration.hasConverged()) { ... registration.getFinalTransformation() ... registration.report() ... }
/// \endcode
///
/// The source is one of: features set by setSourceFeatures(); the features of the source cloud, if both clouds are
/// lidar scans with scan lines; else all finite points of the source, each against the plane of its neighbours in the
/// target, with all lengths relative to the target's point spacing. The target is the map set by setInputTargetMap(),
/// or the target cloud.
///
/// Of ICP's settings, `setMaximumIterations` (default here 30), `setMaxCorrespondenceDistance` (bounds the neighbours'
/// distance), `setTransformationEpsilon` (a squared translation) and `setTransformationRotationEpsilon` (a cosine)
/// are honoured when set; they take precedence over the parameters.
template <typename PointSource, typename PointTarget, typename Scalar = float>
class EdgePlaneRegistration : public pcl::IterativeClosestPoint<PointSource, PointTarget, Scalar> {
  using Base = pcl::IterativeClosestPoint<PointSource, PointTarget, Scalar>;

public:
  using Ptr = pcl::shared_ptr<EdgePlaneRegistration<PointSource, PointTarget, Scalar>>;
  using ConstPtr = pcl::shared_ptr<const EdgePlaneRegistration<PointSource, PointTarget, Scalar>>;
  using PointCloudSource = typename Base::PointCloudSource;
  using PointCloudTarget = typename Base::PointCloudTarget;
  using PointCloudTargetConstPtr = typename Base::PointCloudTargetConstPtr;
  using Matrix4 = typename Base::Matrix4;

  EdgePlaneRegistration();

  /// \throws std::invalid_argument if a parameter is out of its range.
  void setParameters(const RegistrationParameters& parameters);
  [[nodiscard]] const RegistrationParameters& getParameters() const { return parameters_; }

  /// Settings of the features that are extracted from clouds with scan lines.
  /// \throws std::invalid_argument if a parameter is out of its range.
  void setFeatureParameters(const FeatureParameters& parameters);
  [[nodiscard]] const FeatureParameters& getFeatureParameters() const { return feature_parameters_; }

  /// The beams of the sensor that took both clouds. Default: unknown.
  void setSensor(const SensorModel& sensor);
  [[nodiscard]] const SensorModel& getSensor() const { return sensor_; }

  /// Features to register in place of those of the source cloud (which is still the one that align() transforms).
  void setSourceFeatures(const FeatureSet& features) { source_features_ = features; }
  void clearSourceFeatures() { source_features_.reset(); }

  /// A map to register against in place of the target cloud; null to go back to that. The base class still needs a
  /// target cloud for align() and getFitnessScore(): the map's plane layer is set as such if none is.
  void setInputTargetMap(const KeyframeVoxelMap::ConstPtr& map);
  [[nodiscard]] KeyframeVoxelMap::ConstPtr getInputTargetMap() const { return target_map_; }

  void setInputTarget(const PointCloudTargetConstPtr& cloud) override;

  /// Threads for the search of correspondences, 1 or more; the result does not depend on it. 0 uses all processors.
  void setNumberOfThreads(unsigned int threads = 0);
  [[nodiscard]] int getNumberOfThreads() const { return threads_; }

  /// What came of the last align().
  [[nodiscard]] const RegistrationReport& report() const { return report_; }

protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  /// What the target cloud was turned into; kept until the target changes.
  struct Target {
    std::unique_ptr<KeyframeVoxelMap> features;  ///< of a cloud with scan lines
    std::unique_ptr<NeighborSearch> points;      ///< of any cloud
    double spacing = 0.0;                        ///< typical distance of neighbouring points, m
  };

  [[nodiscard]] FeatureSet sourceFeatures(bool from_scan_lines) const;
  void prepareTarget();
  [[nodiscard]] RegistrationParameters effectiveParameters(bool from_scan_lines) const;
  [[nodiscard]] RegistrationReport registerSource(const SE3& guess);

  RegistrationParameters parameters_;
  FeatureParameters feature_parameters_;
  SensorModel sensor_;
  std::optional<FeatureSet> source_features_;
  KeyframeVoxelMap::ConstPtr target_map_;
  std::shared_ptr<Target> prepared_target_;
  RegistrationReport report_;
  int threads_ = 1;
};

}  // namespace pcl_floam

#include <pcl_floam/registration/impl/edge_plane_registration.hpp>
