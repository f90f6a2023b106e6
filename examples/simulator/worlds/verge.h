/// \file verge.h
/// What lies beside a carriageway: ditches, banks, grass, hedges and woods.
#pragma once

#include "way.h"

namespace pcl_floam::simulator {

/// What one side of a road is drawn from.
struct VergeRanges {
  double paved = 0.5;              ///< m beside the carriageway that no grass grows on
  Interval level{1.5, 6.0};        ///< m of level ground beside the carriageway
  Interval ditch{0.2, 0.6};        ///< m deep
  double ditch_chance = 0.5;       ///< that there is one
  Interval bank{0.0, 3.0};         ///< m that the ground beyond is higher; below zero the road lies on a dam
  Interval slope{5.0, 15.0};       ///< m across, from the level ground to the bank's top
  Interval rough{0.03, 0.1};       ///< m, standard deviation of the ground's height
  Interval grass{0.1, 0.4};        ///< m high
  Interval tufts{0.5, 2.0};        ///< of grass, in a square metre
  double belt_chance = 0.97;       ///< that bushes grow there
  Interval belt{2.0, 10.0};        ///< m from the carriageway to the first bushes
  Interval belt_depth{6.0, 20.0};  ///< m
  Interval cover{0.7, 2.0};        ///< of the belt's ground, that bushes stand on
  Interval height{1.5, 5.0};       ///< m, of the tallest bushes
};

/// One side of a road, as it is drawn.
class Verge {
public:
  /// \param edge m to the left of the way where the carriageway ends; the verge lies on the far side of it
  Verge(const VergeRanges& ranges, double edge, Random& random);

  /// m above the level of the way; 0 on the carriageway.
  [[nodiscard]] double height(double along, double left) const;

  /// Adds grass, and the bushes of the belt.
  void plant(TriangleMesh& mesh, Random& random, const Way& way) const;

private:
  /// A place at random, so far from the carriageway.
  [[nodiscard]] SE3 place(const Way& way, Random& random, const Interval& aside) const;

  VergeRanges ranges_;
  double edge_, side_;
  double level_, ditch_, bank_, slope_;
  SmoothNoise swell_;  // of the bank along the road: cuttings become dams
  Terrain bumps_;
};

}  // namespace pcl_floam::simulator
