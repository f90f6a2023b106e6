#include "registration/placed_points.h"

#include "map/surface_fit.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// How far a laser's direction is from the one it is said to have, one standard deviation in rad: half of the 0.07
/// degrees that calibrations of spinning lidars find (Glennie and Lichti 2010; Glennie, Kusari and Facchin 2016). With
/// all of it, far ground would count so little that cars that keep pace outweigh it.
constexpr double kDirectionError = 6e-4;
/// All of a laser's points share it: of a plane it is the fewest lasers that count, not their points.
constexpr double kLasersOfAPlane = 3.0;

/// Looks for the surfaces of those points alone that are elsewhere than when they were found before.
/// \param found of the first one and each \p stride after it
void findAgain(const SurfaceSearch& target, PlacedPoints& placed, std::size_t stride, FoundSurface* found)
{
  constexpr double kUnmoved = 0.005;  // m: a quarter of what a return may be off
  std::array<Eigen::Vector3d, PlacedPoints::kMost> moved;
  std::array<std::size_t, PlacedPoints::kMost> which;
  std::size_t n = 0;
  for (std::size_t i = 0; i < placed.count; ++i) {
    const Eigen::Vector3d& place = placed.points[i].place;
    if (!((place - found[i * stride].at).squaredNorm() < kUnmoved * kUnmoved)) {
      moved[n] = place;
      which[n++] = i * stride;
    }
  }
  if (n > 0) {
    target.find(moved.data(), n, placed.surfaces.data());
  }
  for (std::size_t k = 0; k < n; ++k) {
    found[which[k]] = {moved[k], placed.surfaces[k]};
  }
  for (std::size_t i = 0; i < placed.count; ++i) {
    placed.surfaces[i] = found[i * stride].surface;
  }
}

}  // namespace

std::size_t PlacedPoints::chunksOf(const SurfaceTerm& term, std::size_t stride)
{
  const bool is_given = term.points != nullptr && term.target != nullptr;
  const std::size_t count = is_given ? (term.points->size() + stride - 1) / stride : 0;
  return (count + kMost - 1) / kMost;
}

std::size_t coarseStride(const SurfaceTerm& term)
{
  constexpr std::size_t kMany = 800;  // points: of fewer a part leaves directions open that all of them hold
  constexpr std::size_t kOneIn = 4;
  return term.points != nullptr && term.points->size() >= kMany ? kOneIn : 1;
}

PlacedPoints::PlacedPoints(const SweepTrajectory& sensor, const SurfaceTerm& term, std::size_t chunk,
                           std::size_t stride, FoundSurface* found)
    : begin(chunk * kMost), count(std::min((term.points->size() + stride - 1) / stride - begin, kMost))
{
  std::array<Eigen::Vector3d, kMost> places;
  const ScanPoint* taken = term.points->data() + begin * stride;
  const SE3& pose = sensor.pose();
  sensor.undistorted(taken, stride, count, [&](std::size_t i, const Eigen::Vector3d& place) {
    const ScanPoint& point = taken[i * stride];
    points[i].measured = &point;
    points[i].arm = pose.rotation * place;  // seen from mid-sweep
    points[i].place = places[i] = pose.translation + points[i].arm;
    points[i].since_middle = sensor.sinceReference(static_cast<double>(point.time));
  });
  if (found == nullptr) {
    term.target->find(places.data(), count, surfaces.data());
  } else {
    findAgain(*term.target, *this, stride, found + begin * stride);
  }
}

double rmsRange(const std::vector<ScanPoint>& points)
{
  constexpr double kLeast = 1e-3;  // m: turns are divided by it
  double squares = 0.0;
  for (const ScanPoint& point : points) {
    squares += static_cast<double>(point.x * point.x + point.y * point.y + point.z * point.z);
  }
  return points.empty() ? 1.0 : std::max(kLeast, std::sqrt(squares / static_cast<double>(points.size())));
}

double varianceFrom(const Surface& plane, const PlacedPoint& point, const Eigen::Vector3d& turn,
                    double squared_distance)
{
  const double along = std::max(0.0, (point.place - plane.center).squaredNorm() - squared_distance);
  const double lever = 1.0 + along / std::max(plane.extent, kNoExtent);
  const double by_direction = kDirectionError * kDirectionError * turn.squaredNorm();
  return kRangeNoise * kRangeNoise + plane.thickness * (1.0 + lever / plane.count) +
         by_direction * (1.0 + lever / kLasersOfAPlane);
}

double varianceFrom(const Surface& line_or_point)
{
  return kRangeNoise * kRangeNoise + line_or_point.thickness;
}

}  // namespace pcl_floam
