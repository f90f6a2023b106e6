// FeatureExtraction: what its templates do.
#pragma once

// PCL's own templates, too: its libraries hold them for PCL's point types only, not for PointXYZIRT or yours.
#include <pcl/common/point_tests.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>

#include <cstdint>
#include <vector>

namespace pcl_floam {

template <typename PointT>
void FeatureExtraction<PointT>::extractFromInput(FeatureSet& features)
{
  const CloudView cloud = sensor_pose_.ofSensor(viewOf(*this->input_));
  findScanLines(cloud, sensor_, line_source_, lines_, threads_);
  timing_ = findScanTiming(cloud, lines_, timing_source_, threads_);
  std::vector<std::uint8_t> selectable;
  if (!this->fake_indices_ && this->indices_) {
    selectable = maskOf(*this->indices_, cloud.size);
  }
  extractFeatures(cloud, lines_, timing_, parameters_, features, selectable, threads_);
  if (!sensor_pose_.isIdentity()) {
    moveFeatures(features, sensor_pose_.get());
  }
}

template <typename PointT>
bool FeatureExtraction<PointT>::extract(FeatureSet& features)
{
  features.clear();
  if (!this->initCompute()) {
    return false;
  }
  extractFromInput(features);
  this->deinitCompute();
  return lines_.valid();
}

template <typename PointT>
void FeatureExtraction<PointT>::applyFilter(pcl::Indices& indices)
{
  FeatureSet features;
  extractFromInput(features);
  std::vector<std::uint8_t> is_feature(this->input_->size(), 0);
  for (const Feature& feature : kind_ == FeatureKind::edge ? features.edges : features.planes) {
    is_feature[static_cast<std::size_t>(feature.index)] = 1;
  }
  // Into vectors of our own first: `indices` may be the very vector that the user set as indices.
  pcl::Indices selected;
  pcl::Indices removed;
  for (const auto index : *this->indices_) {
    const bool inside = index >= 0 && static_cast<std::size_t>(index) < this->input_->size();
    if (inside && pcl::isFinite((*this->input_)[static_cast<std::size_t>(index)]) &&
        (is_feature[static_cast<std::size_t>(index)] != 0) != this->negative_) {
      selected.push_back(index);
    } else {
      removed.push_back(index);
    }
  }
  indices = std::move(selected);
  if (this->extract_removed_indices_) {
    *this->removed_indices_ = std::move(removed);
  }
}

}  // namespace pcl_floam
