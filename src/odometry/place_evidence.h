/// \file place_evidence.h
/// How well motions explain a sweep, place by place: the judge between them.
#pragma once

#include <pcl_floam/filters/core/scan_point.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Of each point the number of the place that it is in: of cells so wide that neighbours tell of other things. Of a car
/// there are a few, of the road that it is on many, whatever each has of points.
/// \param side m, of the map's finest cells
[[nodiscard]] std::vector<std::uint32_t> placesOf(const std::vector<ScanPoint>& points, double side);

/// The evidence of a sweep's points, summed by their places.
[[nodiscard]] std::vector<float> evidenceByPlace(const std::vector<float>& of_points,
                                                 const std::vector<std::uint32_t>& places);

/// By how many places one motion explains sweeps better than another. Sweeps see much the same places, so that all
/// together tell as much as one.
class PlaceVotes {
public:
  /// Of another sweep, as both explain it.
  void add(const std::vector<float>& own, const std::vector<float>& others);

  /// Whether the others are better by more than chance.
  [[nodiscard]] bool areSurelyAgainst() const;

private:
  double lead_ = 0.0;  // of the others
  double differing_ = 0.0;
  double sweeps_ = 0.0;
};

}  // namespace pcl_floam
