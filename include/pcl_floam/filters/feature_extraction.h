/// \file feature_extraction.h
/// Edge and plane features as a PCL filter.
#pragma once

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/filters/core/feature_kind.h>
#include <pcl_floam/filters/core/sensor_model.h>

#include <pcl/filters/filter_indices.h>

namespace pcl_floam {

/// Selects the edge points or the plane points of a lidar scan (the paper's "Sensor Model and Feature Extraction").
///
/// Used as any `pcl::FilterIndices`:
/// \code
/// pcl_floam::FeatureExtraction<pcl::PointXYZI> extraction;
/// extraction.setInputCloud(scan);
/// extraction.setFeatureKind(pcl_floam::FeatureKind::edge);
/// extraction.filter(edges);            // or filter(indices)
/// \endcode
/// or, for both kinds with smoothness, time and the edges' own places beside their points, by extract().
///
/// With indices set, features are chosen among them, while all points of the cloud serve as neighbours. With
/// `setNegative(true)` the finite points that are no such feature are selected. Points that are not finite are
/// selected in neither case and count as removed. A cloud in which no scan lines are found has no features;
/// getScanLines() tells why.
template <typename PointT>
class FeatureExtraction : public pcl::FilterIndices<PointT> {
  using Base = pcl::FilterIndices<PointT>;

public:
  using Ptr = pcl::shared_ptr<FeatureExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const FeatureExtraction<PointT>>;
  using PointCloud = typename Base::PointCloud;

  /// \param extract_removed_indices whether getRemovedIndices() is to be filled, as in every PCL filter
  explicit FeatureExtraction(bool extract_removed_indices = false) : Base(extract_removed_indices)
  {
    this->filter_name_ = "FeatureExtraction";
  }

  /// Which features filter() selects. Default: edges.
  void setFeatureKind(FeatureKind kind) { kind_ = kind; }
  [[nodiscard]] FeatureKind getFeatureKind() const { return kind_; }

  /// \throws std::invalid_argument if a parameter is out of its range.
  void setParameters(const FeatureParameters& parameters)
  {
    validate(parameters);
    parameters_ = parameters;
  }
  [[nodiscard]] const FeatureParameters& getParameters() const { return parameters_; }

  /// The sensor's beams, for clouds that neither have a ring field nor keep the sensor's order. Default: unknown. Of
  /// one without scan lines there are no features.
  void setSensor(const SensorModel& sensor) { sensor_ = sensor; }
  [[nodiscard]] const SensorModel& getSensor() const { return sensor_; }

  /// Where the sensor is in the frame of the clouds, if that is not its own but a vehicle's: scan lines,
  /// times, ranges and smoothness go by where points were measured from. Features are in the clouds' frame.
  /// \throws std::invalid_argument for a pose that is not finite
  void setSensorPose(const SE3& frame_T_sensor) { sensor_pose_.set(frame_T_sensor); }
  [[nodiscard]] const SE3& getSensorPose() const { return sensor_pose_.get(); }

  /// Where the scan lines are to come from. Default: automatic.
  void setScanLineSource(ScanLineSource source) { line_source_ = source; }
  [[nodiscard]] ScanLineSource getScanLineSource() const { return line_source_; }

  /// Where the points' times are to come from. Default: automatic.
  void setScanTimingSource(ScanTimingSource source) { timing_source_ = source; }
  [[nodiscard]] ScanTimingSource getScanTimingSource() const { return timing_source_; }

  /// 1 or more; the result does not depend on it. 0 uses all processors. Default: 1.
  void setNumberOfThreads(unsigned int threads = 0) { threads_ = threadCount(threads); }
  [[nodiscard]] int getNumberOfThreads() const { return threads_; }

  /// Edges and planes of the input cloud in one pass.
  /// \return false if there is no input cloud or it has no scan lines; then \p features is empty.
  bool extract(FeatureSet& features);

  /// The scan lines found by the last filter() or extract(): which source was used, how sure it is, why none.
  [[nodiscard]] const ScanLines& getScanLines() const { return lines_; }

  /// The timing found by the last filter() or extract(). Of a cloud in a vehicle's frame
  /// it holds for the sensor's view of it (\ref SensorPose::ofSensor).
  [[nodiscard]] const ScanTiming& getScanTiming() const { return timing_; }

protected:
  using Base::applyFilter;
  void applyFilter(pcl::Indices& indices) override;

private:
  void extractFromInput(FeatureSet& features);

  FeatureKind kind_ = FeatureKind::edge;
  FeatureParameters parameters_;
  SensorModel sensor_;
  SensorPose sensor_pose_;
  ScanLineSource line_source_ = ScanLineSource::automatic;
  ScanTimingSource timing_source_ = ScanTimingSource::automatic;
  int threads_ = 1;
  ScanLines lines_;
  ScanTiming timing_;
};

}  // namespace pcl_floam

#include <pcl_floam/filters/impl/feature_extraction.hpp>
