/// \file feature_sampling.h
/// Which of a scan's features are worth their time.
#pragma once

#include <pcl_floam/filters/features.h>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// At most so many of the features, evenly taken in their order.
[[nodiscard]] std::vector<Feature> evenly(const std::vector<Feature>& features, std::size_t most);

/// At most \p most_per_cell features of each cubic cell of the sensor's frame: the first ones. A car beside the sensor
/// has hundreds of points and takes up a few cells, what stands along the road has few and fills many.
/// \param cell m, > 0
[[nodiscard]] std::vector<Feature> atMostPerCell(const std::vector<Feature>& features, float cell, int most_per_cell);

/// Features spread evenly over the scene: no more than one a cell of 2 m, or of less if there would be fewer than 500;
/// all of them if there are no more than that. What is small, as a room, needs smaller cells.
///
/// With every so many-th feature instead, 11 of 38 starts among traffic at 25 m/s (simulated highways, the first scans
/// of test_starts_in_traffic) took the traffic for the world; with these 1 of 112.
[[nodiscard]] FeatureSet spreadSample(const FeatureSet& features);

}  // namespace pcl_floam
