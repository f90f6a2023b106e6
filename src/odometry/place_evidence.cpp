#include "odometry/place_evidence.h"

#include "map/voxel_table.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

std::vector<std::uint32_t> placesOf(const std::vector<ScanPoint>& points, double side)
{
  constexpr double kPlace = 4.0;  // sides of the map's finest cells
  std::vector<std::uint32_t> places;
  places.reserve(points.size());
  VoxelTable numbers;  // from 1 on
  for (const ScanPoint& point : points) {
    VoxelKey key;
    findKey(Eigen::Vector3f(point.x, point.y, point.z).cast<double>(), 1.0 / (kPlace * side), key);
    std::uint32_t& number = numbers[key.packed(0)];
    number = number == 0 ? static_cast<std::uint32_t>(numbers.size()) : number;
    places.push_back(number - 1);
  }
  return places;
}

std::vector<float> evidenceByPlace(const std::vector<float>& of_points, const std::vector<std::uint32_t>& places)
{
  const std::size_t count = places.empty() ? 0 : *std::max_element(places.begin(), places.end()) + std::size_t{1};
  std::vector<float> sums(count, 0.0F);
  for (std::size_t i = 0; i < std::min(of_points.size(), places.size()); ++i) {
    sums[places[i]] += of_points[i];
  }
  return sums;
}

void PlaceVotes::add(const std::vector<float>& own, const std::vector<float>& others)
{
  for (std::size_t i = 0; i < std::min(own.size(), others.size()); ++i) {
    if (own[i] == 0.0F || others[i] == 0.0F) {
      continue;  // one of the maps knows nothing there: a sensor that has moved less has seen less
    }
    lead_ += static_cast<double>(others[i] > own[i]) - static_cast<double>(others[i] < own[i]);
    differing_ += static_cast<double>(others[i] != own[i]);
  }
  sweeps_ += 1.0;  // also where none differs, as in the first two: young maps tell less than chance allows for
}

/// Of N places that vote by chance, the lead has a variance of N.
bool PlaceVotes::areSurelyAgainst() const
{
  constexpr double kSurely = 4.0;  // standard deviations: several are compared, sweep after sweep, by young maps
  return lead_ > kSurely * std::sqrt(sweeps_ * differing_);
}

}  // namespace pcl_floam
