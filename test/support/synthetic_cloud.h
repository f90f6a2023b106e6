/// \file synthetic_cloud.h
/// Synthetic sweeps as clouds, and their features.
#pragma once

#include "support/synthetic_scan.h"

#include <pcl_floam/common/point_types.h>
#include <pcl_floam/filters/core/feature_extractor.h>

#include <pcl/memory.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

#include <cstring>
#include <string>
#include <vector>

namespace pcl_floam::test {

/// All that a driver tells: x, y, z, ring and time in seconds after the sweep's start.
inline pcl::PointCloud<PointXYZIRT> toCloud(const std::vector<Return>& returns, double period = 0.1)
{
  pcl::PointCloud<PointXYZIRT> cloud;
  for (const Return& r : returns) {
    const Eigen::Vector3f p = r.point.cast<float>();
    cloud.push_back(PointXYZIRT(p.x(), p.y(), p.z(), 1.0F, static_cast<std::uint16_t>(r.ring),
                                static_cast<float>(period * r.fraction)));
  }
  return cloud;
}

inline pcl::PointCloud<PointXYZIRT>::Ptr scanOf(const Room& room)
{
  return pcl::make_shared<pcl::PointCloud<PointXYZIRT>>(toCloud(sweepRoom(room, Lidar())));
}

/// Positions alone.
inline pcl::PointCloud<pcl::PointXYZ> toPositions(const std::vector<Return>& returns)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const Return& r : returns) {
    const Eigen::Vector3f p = r.point.cast<float>();
    cloud.push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  }
  return cloud;
}

/// The features of a sweep by its ring and time fields.
inline FeatureSet featuresOf(const pcl::PointCloud<PointXYZIRT>& cloud, const FeatureParameters& parameters = {})
{
  ScanLines lines;
  FeatureSet features;
  findScanLines(viewOf(cloud), SensorModel(), ScanLineSource::ring_field, lines);
  extractFeatures(viewOf(cloud), lines, findScanTiming(viewOf(cloud), lines), parameters, features);
  return features;
}

/// A cloud whose fields are chosen at run time.
class CloudBuilder {
public:
  /// Adds a field with one value per point.
  template <typename T>
  CloudBuilder& field(const std::string& name, const std::vector<T>& values)
  {
    pcl::PCLPointField description;
    description.name = name;
    description.offset = step_;
    description.datatype = pcl::traits::asEnum<T>::value;
    description.count = 1;
    fields_.push_back(description);
    step_ += static_cast<std::uint32_t>(sizeof(T));
    columns_.emplace_back(values.size() * sizeof(T));
    std::memcpy(columns_.back().data(), values.data(), columns_.back().size());
    size_ = values.size();
    return *this;
  }

  /// Adds x, y and z of a sweep.
  CloudBuilder& positions(const std::vector<Return>& returns)
  {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<float> values;
      for (const Return& r : returns) {
        values.push_back(static_cast<float>(r.point[axis]));
      }
      field(std::string(1, static_cast<char>('x' + axis)), values);
    }
    return *this;
  }

  [[nodiscard]] pcl::PCLPointCloud2 build(std::uint32_t height = 1) const
  {
    pcl::PCLPointCloud2 cloud;
    cloud.fields = fields_;
    cloud.point_step = step_;
    cloud.height = height;
    cloud.width = static_cast<std::uint32_t>(size_) / height;
    cloud.row_step = cloud.width * step_;
    cloud.data.resize(size_ * step_);
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const std::size_t bytes = columns_[f].size() / size_;
      for (std::size_t i = 0; i < size_; ++i) {
        std::memcpy(&cloud.data[i * step_ + fields_[f].offset], &columns_[f][i * bytes], bytes);
      }
    }
    return cloud;
  }

private:
  std::vector<pcl::PCLPointField> fields_;
  std::vector<std::vector<std::uint8_t>> columns_;
  std::uint32_t step_ = 0;
  std::size_t size_ = 0;
};

}  // namespace pcl_floam::test
