/// \file edge_plane_registration.h
/// The pose estimation as a PCL registration.
#pragma once

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/filters/core/sensor_model.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/core/cloud_registration.h>
#include <pcl_floam/registration/core/feature_registration.h>

#include <pcl/console/print.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/registration/icp.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace pcl_floam {

namespace detail {

/// ICP's criteria, which know nothing of the registration before: PCL's compare with its mean squared error.
template <typename Scalar>
class FreshCriteria : public pcl::registration::DefaultConvergenceCriteria<Scalar> {
  using Base = pcl::registration::DefaultConvergenceCriteria<Scalar>;

public:
  using Base::Base;

  void start()
  {
    this->correspondences_prev_mse_ = std::numeric_limits<double>::max();
    this->iterations_similar_transforms_ = 0;
  }
};

}  // namespace detail

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
/// What is registered:
/// - Features set by setSourceFeatures(), or those of the source if both clouds are lidar scans with scan lines,
///   against the map set by setInputTargetMap() or the target's features: the paper's way (\ref registerFeatures).
/// - Else all finite points of both clouds, each pair weighed by the shapes around both points (\ref registerClouds),
///   with no length that is not relative to the clouds' spacing. A cloud whose points show its sensor's scan lines or
///   noise rather than its surfaces is thinned to the means of its points within voxels throughout.
///
/// Should scans have too few features in common, all their points are tried, too.
///
/// Points that are the same are one. Either starts with thinned clouds, unless fewer than 4 iterations are asked for.
///
/// ICP's settings, read when align() runs, also through a base pointer:
/// - `setMaximumIterations` (default here 30, on the full clouds): reaching it is a success.
/// - `setMaxCorrespondenceDistance`: matches are never farther apart. By default they may be at first, and then follow
///   the typical distance.
/// - `setTransformationEpsilon` (a *squared* translation), `setTransformationRotationEpsilon` (a *cosine*),
///   `setEuclideanFitnessEpsilon` (relative change of the mean squared distance) and those of getConvergeCriteria() end
///   the iterations on the full clouds as they end ICP. Unset, these end when no point moves by more than a small
///   fraction of the spacing. Those on features and on thinned clouds do not end sooner for a coarse threshold.
/// - Rejectors run in each iteration, reciprocal matches are honoured, and the visualisation callback is called once an
///   iteration on the full clouds. Matches of thinned clouds, which rejectors see, too, name the points nearest to the
///   voxels' means.
/// - A search object set by `setSearchMethodTarget` is used as it is if it is told not to be recomputed, is of a class
///   of its own or has a point representation of its own; else a faster tree of the same points is asked. Of the
///   source's search object, reciprocal matches make no use: they come from a tree of the library's own.
/// - A transformation estimation or correspondence estimation set by the user takes over: ICP's own loop then runs
///   with it, and the covariance is that of a pose of which nothing is known.
/// - A guess that is no rigid motion is carried along, as in ICP: the source is registered as the guess bends it.
/// - `setRANSACIterations`, `setRANSACOutlierRejectionThreshold`: without effect, as in ICP itself.
///
/// Rejectors, reciprocal matches, the Euclidean fitness epsilon and a search object of the user's speak of points: with
/// them scans are registered by all points, too.
///
/// Input that constrains no pose is reported: hasConverged() is false, report() and an error message tell why, or the
/// best partial answer comes with its weak directions. Indices that are out of the source's range count as such input.
///
/// Header-only like all classes that derive from PCL's, whose layout depends on the compiler's flags; what is compiled
/// in advance is the core, for all point types alike. Types of one's own need nothing but their registration with PCL
/// (and `PCL_NO_PRECOMPILE` where PCL's own classes do).
template <typename PointSource, typename PointTarget, typename Scalar = float>
class EdgePlaneRegistration : public pcl::IterativeClosestPoint<PointSource, PointTarget, Scalar> {
  using Base = pcl::IterativeClosestPoint<PointSource, PointTarget, Scalar>;
  using Criteria = pcl::registration::DefaultConvergenceCriteria<Scalar>;

public:
  using Ptr = pcl::shared_ptr<EdgePlaneRegistration<PointSource, PointTarget, Scalar>>;
  using ConstPtr = pcl::shared_ptr<const EdgePlaneRegistration<PointSource, PointTarget, Scalar>>;
  using PointCloudSource = typename Base::PointCloudSource;
  using PointCloudSourceConstPtr = typename Base::PointCloudSourceConstPtr;
  using PointCloudTarget = typename Base::PointCloudTarget;
  using PointCloudTargetConstPtr = typename Base::PointCloudTargetConstPtr;
  using Matrix4 = typename Base::Matrix4;

  EdgePlaneRegistration();

  /// Where all points are registered, `kernel` and `locked` count; the others are about features.
  void setParameters(const RegistrationParameters& parameters) { parameters_ = parameters; }
  [[nodiscard]] const RegistrationParameters& getParameters() const { return parameters_; }

  /// Settings of the features that are extracted from clouds with scan lines.
  /// \throws std::invalid_argument if a parameter is out of its range.
  void setFeatureParameters(const FeatureParameters& parameters)
  {
    validate(parameters);
    feature_parameters_ = parameters;
    prepared_target_.reset();
  }
  [[nodiscard]] const FeatureParameters& getFeatureParameters() const { return feature_parameters_; }

  /// The beams of the sensor that took both clouds. Default: unknown.
  void setSensor(const SensorModel& sensor)
  {
    sensor_ = sensor;
    prepared_target_.reset();
  }
  [[nodiscard]] const SensorModel& getSensor() const { return sensor_; }

  /// Where that sensor is in the clouds' frame, if that is not its own but a vehicle's: scan lines, and with them
  /// features, go by where points were measured from. The pose that is found is that of the clouds' frames.
  /// \throws std::invalid_argument for a pose that is not finite
  void setSensorPose(const SE3& frame_T_sensor)
  {
    sensor_pose_.set(frame_T_sensor);
    prepared_target_.reset();
  }
  [[nodiscard]] const SE3& getSensorPose() const { return sensor_pose_.get(); }

  /// Features to register in place of those of the source cloud (which is still the one that align() transforms).
  void setSourceFeatures(const FeatureSet& features)
  {
    forgetResult();
    source_features_ = features;
  }
  void clearSourceFeatures()
  {
    forgetResult();
    source_features_.reset();
  }
  /// Null if none are set.
  [[nodiscard]] const FeatureSet* getSourceFeatures() const { return source_features_ ? &*source_features_ : nullptr; }

  /// A map to register against in place of the target cloud; null to go back to that. The base class still needs a
  /// target cloud for align() and getFitnessScore(): while none is set, the map's plane layer stands in for it.
  void setInputTargetMap(const KeyframeVoxelMap::ConstPtr& map);
  [[nodiscard]] KeyframeVoxelMap::ConstPtr getInputTargetMap() const { return target_map_; }

  /// Something else that is known of the pose (`target_T_source`), beside the clouds; asked in every iteration.
  /// \throws std::invalid_argument if it is null
  void addFactor(const PoseFactor::ConstPtr& factor)
  {
    if (!factor) {
      throw std::invalid_argument("registration: the factor is null");
    }
    forgetResult();
    factors_.push_back(factor);
  }
  void clearFactors()
  {
    forgetResult();
    factors_.clear();
  }
  [[nodiscard]] const std::vector<PoseFactor::ConstPtr>& getFactors() const { return factors_; }

  /// As ICP's: an empty cloud is refused with an error message, and the one before stays.
  void setInputSource(const PointCloudSourceConstPtr& cloud) override;
  /// See setInputSource(). The cloud is new each time, also under the same pointer.
  void setInputTarget(const PointCloudTargetConstPtr& cloud) override;

  void setIndices(const pcl::IndicesPtr& indices) override { takeIndices(indices); }
  void setIndices(const pcl::IndicesConstPtr& indices) override { takeIndices(indices); }
  void setIndices(const pcl::PointIndices::ConstPtr& indices) override { takeIndices(indices); }
  void setIndices(std::size_t row_start, std::size_t column_start, std::size_t rows, std::size_t columns) override;

  /// Threads for the search of correspondences, 1 or more; the result does not depend on it. 0 uses all processors.
  void setNumberOfThreads(unsigned int threads = 0) { threads_ = threadCount(threads); }
  [[nodiscard]] int getNumberOfThreads() const { return threads_; }

  /// What came of the last align().
  [[nodiscard]] const RegistrationReport& report() const { return report_; }

protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  /// What the target cloud was turned into; kept until the target changes.
  struct Target {
    std::unique_ptr<KeyframeVoxelMap> features;  ///< of a cloud with scan lines
    std::unique_ptr<PreparedCloud> points;       ///< of any cloud, made when it is first needed
    std::unique_ptr<PreparedCloud> thinned;      ///< of a cloud with scan lines
  };

  /// What the last align() found does not belong to other input.
  void forgetResult()
  {
    this->converged_ = false;
    report_ = RegistrationReport();
  }
  template <typename Indices>
  void takeIndices(const Indices& indices)
  {
    given_indices_.reset();
    Base::setIndices(indices);
    checkIndices();
  }
  void takeTarget(const PointCloudTargetConstPtr& cloud);
  void checkIndices();
  [[nodiscard]] std::vector<std::uint8_t> selectableSource() const;
  [[nodiscard]] FeatureSet featuresOf(const CloudView& cloud, const std::vector<std::uint8_t>& selectable);
  [[nodiscard]] const KeyframeVoxelMap* targetFeatures();
  [[nodiscard]] const PreparedCloud& targetPoints();
  [[nodiscard]] bool wantsPoints() const;
  [[nodiscard]] bool hasSearchOfItsOwn() const;
  [[nodiscard]] bool hasCriteriaOfItsOwn() const;
  [[nodiscard]] int iterationLimit() const { return std::max(1, this->max_iterations_); }
  [[nodiscard]] RegistrationReport registerSource(const SE3& guess);
  [[nodiscard]] SE3 roughPose(const SE3& guess);
  [[nodiscard]] RegistrationReport registerByFeatures(const SE3& guess, FeatureSet& source);
  [[nodiscard]] RegistrationReport registerByPoints(const SE3& guess, int max_iterations, bool coarse_first);
  [[nodiscard]] RegistrationReport finishByPoints(const RegistrationReport& by_features);
  void takeSource(const Matrix4& stretch);
  void runBaseLoop(PointCloudSource& output, const Matrix4& guess);
  void setUpCriteria();
  void concludeCriteria();

  // What ICP's settings ask for in each iteration.
  void reject(const SE3& target_T_source, std::vector<PointMatch>& matches);
  bool iterated(const CloudIteration& iteration);
  [[nodiscard]] std::vector<int> searchTarget(const std::vector<int>& source, const SE3& target_T_source);
  void showIteration(const SE3& target_T_source, const std::vector<PointMatch>* matches);
  [[nodiscard]] PointCloudSource movedSource(const SE3& target_T_source);

  RegistrationParameters parameters_;
  std::vector<PoseFactor::ConstPtr> factors_;
  FeatureParameters feature_parameters_;
  SensorModel sensor_;
  SensorPose sensor_pose_;
  std::optional<FeatureSet> source_features_;
  KeyframeVoxelMap::ConstPtr target_map_;
  PointCloudTargetConstPtr map_cloud_;   ///< the target while it stands in for a map
  PointCloudSourceConstPtr registered_;  ///< the source as the guess bends it, while align() runs
  std::shared_ptr<Target> prepared_target_;
  RegistrationReport report_;
  int threads_ = 1;
  pcl::IndicesPtr given_indices_;  ///< by the user, if some of them are out of range
  typename Base::TransformationEstimationPtr own_estimation_;
  typename Base::CorrespondenceEstimationPtr own_correspondences_;
  pcl::PCLPointCloud2::Ptr target_blob_;  ///< for rejectors that ask for it, while align() runs
};

}  // namespace pcl_floam

#include <pcl_floam/registration/impl/edge_plane_registration.hpp>
#include <pcl_floam/registration/impl/edge_plane_registration_input.hpp>
#include <pcl_floam/registration/impl/edge_plane_registration_iteration.hpp>
