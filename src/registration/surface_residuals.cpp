#include "registration/surface_residuals.h"

#include "common/pi.h"
#include "map/surface_fit.h"
#include "registration/residual_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pcl_floam {

namespace {

/// How far a laser's direction is from the one it is said to have, one standard deviation in rad: half of the 0.07
/// degrees that calibrations of spinning lidars find (Glennie and Lichti 2010; Glennie, Kusari and Facchin 2016). With
/// all of it, far ground would count so little that cars that keep pace outweigh it.
constexpr double kDirectionError = 6e-4;
/// All of a laser's points share it: of a plane it is the fewest lasers that count, not their points.
constexpr double kLasersOfAPlane = 3.0;
/// Part of what nearest points tell that chance tells as well: which of a map's points is nearest changes with what it
/// happens to have kept. Between a tenth and a fifth it hardly matters. Like all noise it is taken for more than its
/// mean.
constexpr double kNearestByChance = 0.15;
/// Width of the kernel in standard deviations (Geman and McClure): beyond it a residual hardly counts.
constexpr double kKernelWidth = 2.0;

/// A shape has at least this variance along itself, m^2.
constexpr double kNoExtent = 1e-9;

constexpr std::size_t kPointsPerChunk = 64;
static_assert(3 * kPointsPerChunk <= ResidualRows::kRoom, "a point has up to three residuals");

/// How much of a residual counts along a run. The return may be any place of it, so that its variance there is that of
/// an even distribution, L^2 / 12, beside what it is elsewhere (no equation of the paper: it registers smooth points
/// with planes alone).
double feltAlongRun(double squared_run, double variance)
{
  constexpr double kEven = 12.0;
  return std::sqrt(variance / (variance + squared_run / kEven));
}

std::size_t chunksOf(const SurfaceTerm& term, std::size_t stride)
{
  const bool is_given = term.points != nullptr && term.target != nullptr;
  const std::size_t count = is_given ? (term.points->size() + stride - 1) / stride : 0;
  return (count + kPointsPerChunk - 1) / kPointsPerChunk;
}

/// Looks for the surfaces of those points alone that are elsewhere than when they were found before: lines of edges,
/// which are the same for all lasers.
void findAgain(const SurfaceSearch& target, const Eigen::Vector3d* places, const std::uint32_t* lasers,
               std::size_t count, FoundSurface* found, Surface* surfaces)
{
  constexpr double kNegligible = 0.005;  // m: a quarter of what a return may be off
  std::array<Eigen::Vector3d, kPointsPerChunk> moved;
  std::array<std::uint32_t, kPointsPerChunk> lasers_of_moved;
  std::array<std::size_t, kPointsPerChunk> which;
  std::size_t n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!((places[i] - found[i].at).squaredNorm() < kNegligible * kNegligible)) {
      moved[n] = places[i];
      lasers_of_moved[n] = lasers[i];
      which[n++] = i;
    }
  }
  if (n > 0) {
    target.find(moved.data(), lasers_of_moved.data(), n, surfaces);
  }
  for (std::size_t k = 0; k < n; ++k) {
    found[which[k]] = {moved[k], surfaces[k]};
  }
  for (std::size_t i = 0; i < count; ++i) {
    surfaces[i] = found[i].surface;
  }
}

template <typename Iterator>
SurfaceSums totalOf(Iterator begin, Iterator end)
{
  SurfaceSums total;
  std::for_each(begin, end, [&total](const SurfaceSums& part) { total.add(part); });
  return total;
}

}  // namespace

void SurfaceSums::add(const SurfaceSums& other)
{
  equations += other.equations;
  robust_weight += other.robust_weight;
  evidence += other.evidence;
}

SweepSums SurfaceResiduals::sumsOf(const SurfaceTerm& scan, const SurfaceTerm& edges, std::size_t stride,
                                   SurfaceRoom& room) const
{
  std::vector<SurfaceSums>& parts = room.parts;
  const std::size_t of_scan = chunksOf(scan, stride);
  parts.resize(of_scan + chunksOf(edges, 1));
  room.evidence.assign(weighs_evidence ? scan.points->size() : 0, 0.0F);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::ptrdiff_t part = 0; part < static_cast<std::ptrdiff_t>(parts.size()); ++part) {
    const auto c = static_cast<std::size_t>(part);
    parts[c] = c < of_scan ? chunkOf(scan, c, stride, nullptr, weighs_evidence ? room.evidence.data() : nullptr)
                           : chunkOf(edges, c - of_scan, 1, room.edges.data(), nullptr);
  }
  const auto middle = parts.begin() + static_cast<std::ptrdiff_t>(of_scan);
  return {totalOf(parts.begin(), middle), totalOf(middle, parts.end())};
}

/// \param undistorted the point as seen from mid-sweep
PlacedPoint SurfaceResiduals::placedAt(const Eigen::Vector3d& undistorted, const ScanPoint& point) const
{
  const SE3& pose = sensor.pose();
  PlacedPoint placed;
  placed.arm = pose.rotation * undistorted;
  placed.place = pose.translation + placed.arm;
  placed.since_middle = periods * sensor.sinceReference(static_cast<double>(point.time));
  if (!weighs_evidence) {
    placed.run = pose.rotation * Eigen::Vector3f::Map(point.run.data()).cast<double>();
  }
  return placed;
}

/// \param found before, of all points of the term; nullptr: it is not kept
/// \param[out] evidence of all points; nullptr: it is not asked for
SurfaceSums SurfaceResiduals::chunkOf(const SurfaceTerm& term, std::size_t chunk, std::size_t stride,
                                      FoundSurface* found, float* evidence) const
{
  const std::size_t begin = chunk * kPointsPerChunk;
  const std::size_t end = std::min((term.points->size() + stride - 1) / stride, begin + kPointsPerChunk);
  SurfaceSums sums;
  std::array<Eigen::Vector3d, kPointsPerChunk> places;
  std::array<PlacedPoint, kPointsPerChunk> placed;
  std::array<std::uint32_t, kPointsPerChunk> lasers;
  std::array<Surface, kPointsPerChunk> surfaces;
  ResidualRows rows;
  ResidualRows nearest;
  ResidualRows noise;  // what normals and lines' directions that are off add to H
  const ScanPoint* points = term.points->data() + begin * stride;
  sensor.undistorted(points, stride, end - begin, places.data());
  for (std::size_t i = 0; i < end - begin; ++i) {
    placed[i] = placedAt(places[i], points[i * stride]);
    places[i] = placed[i].place;
    lasers[i] = knows_lasers ? points[i * stride].laser : kNoLaser;
  }
  if (found == nullptr) {
    term.target->find(places.data(), lasers.data(), end - begin, surfaces.data());
  } else {
    findAgain(*term.target, places.data(), lasers.data(), end - begin, found + begin, surfaces.data());
  }
  for (std::size_t i = 0; i < end - begin; ++i) {
    const double before = sums.evidence;
    switch (surfaces[i].kind) {
      case SurfaceKind::plane: addPlane(placed[i], surfaces[i], rows, noise, sums); break;
      case SurfaceKind::line: addLine(placed[i], surfaces[i], rows, noise, sums); break;
      case SurfaceKind::point: addPoint(placed[i], surfaces[i], nearest, sums); break;
      case SurfaceKind::unknown: break;
    }
    if (evidence != nullptr) {
      evidence[(begin + i) * stride] = static_cast<float>(sums.evidence - before);
    }
  }
  nearest.addTo(sums.equations);
  NormalEquations by_noise;
  noise.addTo(by_noise);
  sums.equations.noise_information = by_noise.information + kNearestByChance * sums.equations.information;
  rows.addTo(sums.equations);
  return sums;
}

/// Eq. 7, and Eq. 14 with the plane's normal.
void SurfaceResiduals::addPlane(const PlacedPoint& p, const Surface& plane, ResidualRows& rows, ResidualRows& noise,
                                SurfaceSums& sums) const
{
  const Eigen::Vector3d from_center = p.place - plane.center;
  const double r = plane.direction.dot(from_center);
  const double along = std::max(0.0, from_center.squaredNorm() - r * r);
  const double extent = std::max(plane.extent, kNoExtent);
  const double lever = 1.0 + along / extent;
  const double across = plane.direction.cross(p.arm).norm();
  const double by_direction = kDirectionError * kDirectionError * across * across;
  const double variance = kRangeNoise * kRangeNoise + plane.thickness * (1.0 + lever / plane.count) +
                          by_direction * (1.0 + lever / kLasersOfAPlane);
  const double w = weight(r * r, variance, plane.direction, p, sums);
  weighEvidence(r * r, variance, 1.0, sums);
  rows.add(plane.direction, p.arm, r, w, p.since_middle);
  // Three points go into the plane; its thickness is what noise leaves to the others.
  const double by_noise = w * (plane.thickness + 3.0 * kRangeNoise * kRangeNoise / plane.count) / plane.count;
  const bool is_wide = plane.width > 0.0;
  const Eigen::Vector3d wide = is_wide ? plane.wide : Eigen::Vector3d(plane.direction.unitOrthogonal());
  noise.add(wide, p.arm, 0.0, by_noise / (is_wide ? plane.width : extent), 0.0);
  noise.add(plane.direction.cross(wide), p.arm, 0.0, by_noise / extent, 0.0);
  ++sums.equations.planes;
}

/// Eq. 5 and 13: the distance across the line, in two directions.
void SurfaceResiduals::addLine(const PlacedPoint& p, const Surface& line, ResidualRows& rows, ResidualRows& noise,
                               SurfaceSums& sums) const
{
  const double variance = kRangeNoise * kRangeNoise + line.thickness;
  const Eigen::Vector3d from_center = p.place - line.center;
  const Eigen::Vector3d run = p.run - line.direction * line.direction.dot(p.run);
  const double squared_run = run.squaredNorm();
  const bool has_run = squared_run > kNoExtent;
  const Eigen::Vector3d other = has_run ? line.direction.cross(run).normalized() : line.direction.unitOrthogonal();
  const Eigen::Vector3d along = feltAlongRun(squared_run, variance) * other.cross(line.direction);
  const double first = other.dot(from_center);
  const double second = along.dot(from_center);
  const double squared = first * first + second * second;
  const Eigen::Vector3d off =
      squared > 0.0 ? Eigen::Vector3d((first * other + second * along) / std::sqrt(squared)) : other;
  const double w = weight(squared, variance, off, p, sums);
  weighEvidence(squared, variance, 2.0, sums);
  rows.add(other, p.arm, first, w, p.since_middle);
  rows.add(along, p.arm, second, w, p.since_middle);
  // Two points go into the line; its direction may be off to two sides.
  const double count = std::max(1.0, static_cast<double>(line.count));
  const double by_noise = w * (line.thickness + 2.0 * kRangeNoise * kRangeNoise / count) / count;
  const double tilt = 2.0 * by_noise / std::max(line.extent, kNoExtent);
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(line.direction), other, Eigen::Vector3d(other.cross(line.direction))}) {
    noise.add(axis, p.arm, 0.0, tilt, 0.0);
  }
  ++sums.equations.edges;
}

/// The distance to the nearest point, as far as it is felt.
void SurfaceResiduals::addPoint(const PlacedPoint& p, const Surface& near, ResidualRows& rows, SurfaceSums& sums) const
{
  const double variance = kRangeNoise * kRangeNoise + near.thickness;
  const double squared_run = p.run.squaredNorm();
  const Eigen::Vector3d off = p.place - near.center;
  Eigen::Vector3d seen = off;
  Eigen::Matrix3d felt = near.felt;
  if (squared_run > kNoExtent) {  // S off and S felt S with S = 1 - (1 - k) run run^T / |run|^2
    const double k = feltAlongRun(squared_run, variance);
    const double unfelt = (1.0 - k) / squared_run;
    const Eigen::Vector3d along = unfelt * (felt * p.run);
    felt -=
        along * p.run.transpose() + p.run * along.transpose() - unfelt * along.dot(p.run) * p.run * p.run.transpose();
    seen -= unfelt * p.run.dot(off) * p.run;
  }
  const double length = seen.norm();
  const Eigen::Vector3d direction = length > 0.0 ? Eigen::Vector3d(seen / length) : Eigen::Vector3d::Zero();
  const double w = weight(length * length, variance, direction, p, sums);
  weighEvidence(off.dot(felt * off), variance, felt.trace(), sums);
  ++sums.equations.points;
  rows.add(felt, off, p.arm, w, p.since_middle);
}

/// The kernel is as wide as the residual may be off with the pose.
double SurfaceResiduals::weight(double squared, double variance, const Eigen::Vector3d& direction, const PlacedPoint& p,
                                SurfaceSums& sums) const
{
  constexpr double kFits = 3.0;  // standard deviations
  Eigen::Matrix<double, 6, 1> row;
  row << direction, p.arm.cross(direction);
  const double width = kKernelWidth * kKernelWidth * (variance + row.dot(reach * row));
  const double ratio = width / (width + squared);
  const double robust = ratio * ratio;
  sums.equations.cost += 0.5 * robust * squared / variance;
  sums.equations.weight += robust / variance;
  sums.equations.squared_extent += robust / variance * p.arm.squaredNorm();
  sums.equations.weighted_squares += robust * squared;
  sums.equations.plane_inliers += squared < kFits * kFits * variance ? 1 : 0;
  sums.robust_weight += robust;
  return robust / variance;
}

/// A density, of all points that may be anywhere within a metre: so what fills its cell, and is near wherever the
/// sensor is supposed to be, tells nothing, and what is in one place, more than what is in one plane. \param dimensions
/// in which the surface tells where its points are: 1 for a plane, 2 for a line
void SurfaceResiduals::weighEvidence(double squared, double variance, double dimensions, SurfaceSums& sums) const
{
  constexpr double kOutliers = 0.01;  // share of the points of which the map knows nothing
  if (weighs_evidence) {
    const double density = std::exp(-0.5 * (squared / variance + dimensions * std::log(2.0 * kPi * variance)));
    sums.evidence += std::log(kOutliers + (1.0 - kOutliers) * density) / kResidualsPerIndependentOne;
  }
}

}  // namespace pcl_floam
