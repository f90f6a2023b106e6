#include "registration/surface_residuals.h"

#include "map/surface_fit.h"
#include "registration/residual_rows.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Part of what nearest points tell that chance tells as well: which of a map's points is nearest changes with what it
/// happens to have kept. Between a tenth and a fifth it hardly matters. Like all noise it is taken for more than its
/// mean.
constexpr double kNearestByChance = 0.15;
/// Width of the kernel in standard deviations (Geman and McClure): beyond it a residual hardly counts.
constexpr double kKernelWidth = 2.0;

static_assert(3 * PlacedPoints::kMost <= ResidualRows::kRoom, "a point has up to three residuals");

/// How much of a residual counts along a run. The return may be any place of it, so that its variance there is that of
/// an even distribution, L^2 / 12, beside what it is elsewhere (no equation of the paper: it registers smooth points
/// with planes alone).
double observedAlongRun(double squared_run, double variance)
{
  constexpr double kEven = 12.0;
  return std::sqrt(variance / (variance + squared_run / kEven));
}

/// n^T [I, -[arm]x] (Eq. 11, 13, 14).
Vector6 derivativeAlong(const Eigen::Vector3d& normal, const PlacedPoint& point)
{
  Vector6 derivative;
  derivative << normal, point.arm.cross(normal);
  return derivative;
}

/// What the residuals of some points come to.
struct ChunkRows {
  ResidualRows measured;
  ResidualRows nearest;
  ResidualRows noise;  // what normals and lines' directions that are off add to H

  void add(const Vector6& derivative, double residual, double weight, double since_middle)
  {
    measured.add(derivative, residual, weight, since_middle);
  }
  void addNearest(const Eigen::Matrix3d& observed, const Eigen::Vector3d& off, const PlacedPoint& p, double weight,
                  double since_middle)
  {
    nearest.add(observed, off, p.arm, weight, since_middle);
  }
  void addNoise(const Eigen::Vector3d& normal, const PlacedPoint& p, double weight)
  {
    noise.add(derivativeAlong(normal, p), 0.0, weight, 0.0);
  }

  void addTo(SurfaceSums& sums)
  {
    nearest.addTo(sums.equations);
    NormalEquations by_noise;
    noise.addTo(by_noise);
    sums.equations.noise_information = by_noise.information + kNearestByChance * sums.equations.information;
    measured.addTo(sums.equations);
  }
};

/// The same along some motions.
struct ChunkPulls {
  const TriedMotions& motions;
  Pulls pulls;

  void add(const Vector6& derivative, double residual, double weight, double /*since_middle*/)
  {
    const Eigen::Vector3d along = motions.transpose() * derivative;
    pulls.against += weight * residual * along;
    pulls.stiffness += weight * along * along.transpose();
  }
  void addNearest(const Eigen::Matrix3d& observed, const Eigen::Vector3d& off, const PlacedPoint& p, double weight,
                  double /*since_middle*/)
  {
    Eigen::Matrix3d moved;  // the point, by each
    for (Eigen::Index i = 0; i < 3; ++i) {
      moved.col(i) = motions.col(i).head<3>() + Eigen::Vector3d(motions.col(i).tail<3>()).cross(p.arm);
    }
    const Eigen::Matrix3d seen = weight * observed * moved;
    pulls.against += seen.transpose() * off;
    pulls.stiffness += seen.transpose() * moved;
  }
  void addNoise(const Eigen::Vector3d& /*normal*/, const PlacedPoint& /*p*/, double /*weight*/) {}
};

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
}

SweepSums SurfaceResiduals::sumsOf(const SurfaceTerm& scan, std::size_t stride, const SurfaceTerm& edges,
                                   std::size_t edge_stride, SurfaceRoom& room) const
{
  std::vector<SurfaceSums>& parts = room.parts;
  const std::size_t of_scan = PlacedPoints::chunksOf(scan, stride);
  parts.resize(of_scan + PlacedPoints::chunksOf(edges, edge_stride));
  forEachChunk(sensor, scan, stride, edges, edge_stride, room.edges.data(), threads,
               [&](std::size_t c, const PlacedPoints& placed) {
                 parts[c] = SurfaceSums();
                 ChunkRows rows;
                 addAll(placed, rows, parts[c]);
                 rows.addTo(parts[c]);
               });
  const auto middle = parts.begin() + static_cast<std::ptrdiff_t>(of_scan);
  return {totalOf(parts.begin(), middle), totalOf(middle, parts.end())};
}

Pulls SurfaceResiduals::pullsAlong(const TriedMotions& motions, const SurfaceTerm& scan, const SurfaceTerm& edges,
                                   SurfaceRoom& room) const
{
  const std::size_t stride = coarseStride(scan);
  room.pulls.resize(PlacedPoints::chunksOf(scan, stride) + PlacedPoints::chunksOf(edges, 1));
  forEachChunk(sensor, scan, stride, edges, 1, nullptr, threads, [&](std::size_t c, const PlacedPoints& placed) {
    ChunkPulls rows{motions, {}};
    SurfaceSums unused;
    addAll(placed, rows, unused);
    room.pulls[c] = rows.pulls;
  });
  Pulls total;
  for (const Pulls& pulls : room.pulls) {
    total.against += pulls.against;
    total.stiffness += pulls.stiffness;
  }
  return total;
}

template <typename Rows>
void SurfaceResiduals::addAll(const PlacedPoints& placed, Rows& rows, SurfaceSums& sums) const
{
  for (std::size_t i = 0; i < placed.count; ++i) {
    const PlacedPoint& point = placed.points[i];
    const Surface& surface = placed.surfaces[i];
    switch (surface.kind) {
      case SurfaceKind::plane: addPlane(point, surface, rows, sums); break;
      case SurfaceKind::line: addLine(point, surface, rows, sums); break;
      case SurfaceKind::point: addPoint(point, surface, rows, sums); break;
      case SurfaceKind::unknown: break;
    }
  }
}

/// Into the target's axes.
Eigen::Vector3d SurfaceResiduals::turned(const std::array<float, 3>& run) const
{
  return sensor.pose().rotation * Eigen::Vector3f::Map(run.data()).cast<double>();
}

/// Eq. 7, and Eq. 14 with the plane's normal.
template <typename Rows>
void SurfaceResiduals::addPlane(const PlacedPoint& p, const Surface& plane, Rows& rows, SurfaceSums& sums) const
{
  const double r = plane.direction.dot(p.place - plane.center);
  const double extent = std::max(plane.extent, kNoExtent);
  const Vector6 derivative = derivativeAlong(plane.direction, p);
  const double w = weight(r * r, varianceFrom(plane, p, derivative.tail<3>(), r * r), derivative, p, sums);
  rows.add(derivative, r, w, periods * p.since_middle);
  // Three points go into the plane; its thickness is what noise leaves to the others.
  const double by_noise = w * (plane.thickness + 3.0 * kRangeNoise * kRangeNoise / plane.count) / plane.count;
  const bool is_wide = plane.width > 0.0;
  const Eigen::Vector3d wide = is_wide ? plane.wide : Eigen::Vector3d(plane.direction.unitOrthogonal());
  rows.addNoise(wide, p, by_noise / (is_wide ? plane.width : extent));
  rows.addNoise(plane.direction.cross(wide), p, by_noise / extent);
  ++sums.equations.planes;
}

/// Eq. 5 and 13: the distance across the line, in two directions.
template <typename Rows>
void SurfaceResiduals::addLine(const PlacedPoint& p, const Surface& line, Rows& rows, SurfaceSums& sums) const
{
  const double variance = varianceFrom(line);
  const Eigen::Vector3d from_center = p.place - line.center;
  const auto acrossLine = [&](const std::array<float, 3>& measured) {
    const Eigen::Vector3d whole = turned(measured);
    return Eigen::Vector3d(whole - line.direction * line.direction.dot(whole));
  };
  const Eigen::Vector3d one = acrossLine(p.measured->run);
  const Eigen::Vector3d next = acrossLine(p.measured->run_across);
  const Eigen::Vector3d run = one.squaredNorm() < next.squaredNorm() ? next : one;  // the other is along the line
  const double squared_run = run.squaredNorm();
  const bool has_run = squared_run > kNoExtent;
  const Eigen::Vector3d other = has_run ? line.direction.cross(run).normalized() : line.direction.unitOrthogonal();
  const Eigen::Vector3d along = observedAlongRun(squared_run, variance) * other.cross(line.direction);
  const double first = other.dot(from_center);
  const double second = along.dot(from_center);
  const double squared = first * first + second * second;
  const Eigen::Vector3d off =
      squared > 0.0 ? Eigen::Vector3d((first * other + second * along) / std::sqrt(squared)) : other;
  const double w = weight(squared, variance, derivativeAlong(off, p), p, sums);
  rows.add(derivativeAlong(other, p), first, w, periods * p.since_middle);
  rows.add(derivativeAlong(along, p), second, w, periods * p.since_middle);
  // Two points go into the line; its direction may be off to two sides.
  const double count = std::max(1.0, static_cast<double>(line.count));
  const double by_noise = w * (line.thickness + 2.0 * kRangeNoise * kRangeNoise / count) / count;
  const double tilt = 2.0 * by_noise / std::max(line.extent, kNoExtent);
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(line.direction), other, Eigen::Vector3d(other.cross(line.direction))}) {
    rows.addNoise(axis, p, tilt);
  }
  ++sums.equations.edges;
}

/// The distance to the nearest point, as far as it can be observed.
template <typename Rows>
void SurfaceResiduals::addPoint(const PlacedPoint& p, const Surface& near, Rows& rows, SurfaceSums& sums) const
{
  const double variance = varianceFrom(near);
  const Eigen::Vector3d off = p.place - near.center;
  Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();  // of a displacement
  for (const std::array<float, 3>* measured : {&p.measured->run, &p.measured->run_across}) {
    const Eigen::Vector3d run = turned(*measured);
    const double squared_run = run.squaredNorm();
    if (squared_run > kNoExtent) {
      kept -= (1.0 - observedAlongRun(squared_run, variance)) / squared_run * (kept * run) * run.transpose();
    }
  }
  const Eigen::Vector3d seen = kept * off;
  const Eigen::Matrix3d observed = kept.transpose() * near.observability * kept;
  const double length = seen.norm();
  const Eigen::Vector3d direction = length > 0.0 ? Eigen::Vector3d(seen / length) : Eigen::Vector3d::Zero();
  const double w = weight(length * length, variance, derivativeAlong(direction, p), p, sums);
  ++sums.equations.points;
  rows.addNearest(observed, off, p, w, periods * p.since_middle);
}

/// The kernel is as wide as the residual may be off with the pose.
double SurfaceResiduals::weight(double squared, double variance, const Vector6& derivative, const PlacedPoint& p,
                                SurfaceSums& sums) const
{
  constexpr double kFits = 3.0;  // standard deviations
  const double width = kKernelWidth * kKernelWidth * (variance + derivative.dot(pose_uncertainty * derivative));
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

}  // namespace pcl_floam
