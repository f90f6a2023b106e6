#include "registration/surface_registration.h"

#include "map/laser_support.h"
#include "registration/sweep_points.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_floam {

namespace {

/// Standard deviation of a return's place, m.
constexpr double kRangeNoise = 0.02;
/// What a pose may be off where nothing is known against it, m.
constexpr double kLeastDoubt = 0.02;
/// Width of the kernel in standard deviations (Geman and McClure): beyond it a residual hardly counts.
constexpr double kKernelWidth = 2.0;
/// So many standard deviations of the guess are looked at in the first iteration; halved with each.
constexpr double kFirstLook = 3.0;
/// The first iterations, which look far, take one point in so many, if there are enough.
constexpr std::size_t kFirstStride = 4;
constexpr std::size_t kManyPoints = 800;
/// Correspondences that are needed for a pose.
constexpr int kFewest = 20;
/// A step that ends the iterations, in standard deviations of the pose.
constexpr double kSmallStep = 0.1;
constexpr int kFewestIterations = 4;

constexpr std::ptrdiff_t kChunk = 128;

/// H, b and what the report tells, of some of the residuals (Eq. 10 to 14).
struct Sums {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double cost = 0.0;
  double squares = 0.0;
  double weight = 0.0;
  double evidence = 0.0;
  double total = 0.0;           // of the residuals' weights, 1/m^2
  double squared_extent = 0.0;  // of the points from the sensor, weighted likewise
  int planes = 0, lines = 0, points = 0, fits = 0;

  [[nodiscard]] int count() const { return planes + lines + points; }

  void add(const Sums& other)
  {
    information += other.information;
    gradient += other.gradient;
    cost += other.cost;
    squares += other.squares;
    weight += other.weight;
    evidence += other.evidence;
    total += other.total;
    squared_extent += other.squared_extent;
    planes += other.planes;
    lines += other.lines;
    points += other.points;
    fits += other.fits;
  }
};

/// A point where the present estimate has it.
struct PlacedPoint {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();    ///< from the sensor
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< in the target's frame
  double since_middle = 0.0;  ///< in sweeps: so much of what the pose makes of the sweep's motion moves it, too
};

class PoseEstimation {
public:
  explicit PoseEstimation(const SurfaceProblem& problem) : problem_(problem), pose_(problem.guess)
  {
    const Eigen::Matrix<double, 6, 6> covariance = problem.guess_covariance;
    doubt_ = covariance.topLeftCorner<3, 3>().trace();
    if (problem.guess_is_prior) {
      prior_ = covariance.inverse();
    }
  }

  SurfaceRegistration run()
  {
    SurfaceRegistration result;
    RegistrationReport& report = result.report;
    report.termination = Termination::iteration_limit;
    Sums sums;
    double look = kFirstLook;
    for (int i = 0; i < problem_.max_iterations && report.hasConverged(); ++i, look *= 0.5) {
      const bool narrow = look * look * doubt_ <= kLeastDoubt * kLeastDoubt;
      const bool all = narrow || i >= kFewestIterations || problem_.scan.points->size() < kManyPoints;
      turnSweepGain();
      sums = accumulate(look, all ? 1 : kFirstStride);
      report.iterations = i + 1;
      const Vector6 step = sums.count() < kFewest ? Vector6(Vector6::Zero()) : stepOf(sums);
      if (sums.count() < kFewest) {
        report.termination = Termination::too_few_correspondences;
      } else if (!step.allFinite()) {
        report.termination = Termination::degenerate;
      } else if (take(step, sums) && all && i + 1 >= kFewestIterations) {
        report.termination = Termination::converged;
      }
      if (report.termination == Termination::converged) {
        break;
      }
    }
    conclude(result, sums);
    if (problem_.wants_evidence && report.hasConverged()) {
      weighs_evidence_ = true;
      result.evidence = accumulate(0.0, 1).evidence;
    }
    return result;
  }

private:
  /// \return whether it was a small step
  bool take(const Vector6& step, const Sums& sums)
  {
    pose_.translation += step.head<3>();
    pose_.rotation = nearestRotation(expSO3(step.tail<3>()) * pose_.rotation);
    const Vector6 seen = sums.information * step;
    return step.dot(seen) < kSmallStep * kSmallStep * kResidualsPerIndependentOne;
  }

  void turnSweepGain()
  {
    Eigen::Matrix<double, 6, 6> r = Eigen::Matrix<double, 6, 6>::Zero();
    r.topLeftCorner<3, 3>() = pose_.rotation;
    r.bottomRightCorner<3, 3>() = pose_.rotation;
    sweep_gain_ = r * problem_.sweep.gain * r.transpose();
  }

  void conclude(SurfaceRegistration& result, Sums& sums)
  {
    RegistrationReport& report = result.report;
    report.weak_directions = weakDirections(sums);
    keepGuessAlongWeak(report, sums);
    report.target_T_source = report.hasConverged() ? pose_ : problem_.guess;
    report.sweep_twist = sweepTwist();
    report.edge_correspondences = sums.lines;
    report.plane_correspondences = sums.planes;
    report.point_correspondences = sums.points;
    report.plane_inliers = sums.fits;
    report.information = sums.information;
    report.cost = sums.cost;
    report.residual_rms = sums.weight > 0.0 ? std::sqrt(sums.squares / sums.weight) : 0.0;
    report.covariance = posteriorOf(sums.information / kResidualsPerIndependentOne);
    result.posterior = posteriorOf(sums.information);
    result.points = problem_.scan.points->size();
  }

  [[nodiscard]] Matrix6 posteriorOf(const Matrix6& measured) const
  {
    constexpr double kNothingKnown = 1e-6;  // 1/m^2 and 1/rad^2: a kilometre
    constexpr double kHeld = 1e12;
    Eigen::Matrix<double, 6, 6> information = measured + prior_;
    for (int i = 0; i < 6; ++i) {
      information(i, i) += problem_.locked[static_cast<std::size_t>(i)] ? kHeld : kNothingKnown;
    }
    Matrix6 covariance = information.inverse();
    for (int i = 0; i < 6; ++i) {
      if (problem_.locked[static_cast<std::size_t>(i)]) {
        covariance.row(i).setZero();
        covariance.col(i).setZero();
      }
    }
    return covariance;
  }

  /// Those along which an average residual tells hardly anything. Rotations are scaled to metres.
  [[nodiscard]] static std::vector<WeakDirection> weakDirections(const Sums& sums)
  {
    constexpr double kWeak = 1e-3;  // of residuals that tell of the direction alone; noise of the normals gives half
    std::vector<WeakDirection> weak;
    if (!(sums.squared_extent > 0.0)) {
      return weak;
    }
    const Vector6 scale = scaleOf(sums);
    const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * sums.information * scale.asDiagonal() / sums.total;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(scaled);
    for (int i = 0; i < 6 && solver.eigenvalues()[i] < kWeak; ++i) {
      weak.push_back({solver.eigenvectors().col(i), std::max(0.0, solver.eigenvalues()[i])});
    }
    return weak;
  }

  /// Rotations in metres of a typical point's displacement.
  [[nodiscard]] static Vector6 scaleOf(const Sums& sums)
  {
    const double per_metre = std::sqrt(sums.total / sums.squared_extent);
    Vector6 scale;
    scale << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
    return scale;
  }

  /// Along what hardly anything tells of, the pose stays at the guess, and the information is none: what there seems to
  /// be is noise, and follows the sensor (solution remapping after Zhang and Singh, 2016).
  void keepGuessAlongWeak(RegistrationReport& report, Sums& sums)
  {
    if (report.weak_directions.empty()) {
      return;
    }
    const Vector6 scale = scaleOf(sums);
    Eigen::Matrix<double, 6, 6> strong = Eigen::Matrix<double, 6, 6>::Identity();
    for (const WeakDirection& weak : report.weak_directions) {
      const Eigen::Matrix<double, 6, 1> direction = weak.direction;
      strong -= direction * direction.transpose();
    }
    const Eigen::Matrix<double, 6, 6> kept = scale.asDiagonal() * strong * scale.cwiseInverse().asDiagonal();
    Eigen::Matrix<double, 6, 1> off;
    off << pose_.translation - problem_.guess.translation, logSO3(pose_.rotation * problem_.guess.rotation.transpose());
    const Eigen::Matrix<double, 6, 1> moved = kept * off;
    pose_.translation = problem_.guess.translation + moved.head<3>();
    pose_.rotation = nearestRotation(expSO3(moved.tail<3>()) * problem_.guess.rotation);
    sums.information = kept.transpose() * Eigen::Matrix<double, 6, 6>(sums.information) * kept;
  }

  [[nodiscard]] Vector6 sweepTwist() const
  {
    Eigen::Matrix<double, 6, 1> off;
    const Eigen::Matrix3d back = problem_.guess.rotation.transpose();
    off << back * (pose_.translation - problem_.guess.translation), logSO3(back * pose_.rotation);
    return problem_.sweep.twist + problem_.sweep.gain * off;
  }

  [[nodiscard]] Sums accumulate(double look, std::size_t stride) const
  {
    Sums sums = accumulate(problem_.scan, look, stride);
    if (problem_.edges.points != nullptr && problem_.edges.target != nullptr) {
      sums.add(accumulate(problem_.edges, look, 1));
    }
    return sums;
  }

  /// In fixed chunks, added in order: the same bits for every number of threads.
  [[nodiscard]] Sums accumulate(const SurfaceTerm& term, double look, std::size_t stride) const
  {
    const MovingSensor sensor(pose_, sweepTwist());
    const auto count = static_cast<std::ptrdiff_t>((term.points->size() + stride - 1) / stride);
    const std::ptrdiff_t chunks = (count + kChunk - 1) / kChunk;
    std::vector<Sums> parts(static_cast<std::size_t>(chunks));
#pragma omp parallel for num_threads(problem_.threads) schedule(dynamic)
    for (std::ptrdiff_t c = 0; c < chunks; ++c) {
      addChunk(term, sensor, c * kChunk, std::min(count, (c + 1) * kChunk), stride, look,
               parts[static_cast<std::size_t>(c)]);
    }
    Sums sums;
    for (const Sums& part : parts) {
      sums.add(part);
    }
    return sums;
  }

  void addChunk(const SurfaceTerm& term, const MovingSensor& sensor, std::ptrdiff_t begin, std::ptrdiff_t end,
                std::size_t stride, double look, Sums& sums) const
  {
    std::array<Eigen::Vector3d, kChunk> places;
    std::array<PlacedPoint, kChunk> placed;
    std::array<std::uint32_t, kChunk> lasers{};
    std::array<Surface, kChunk> surfaces;
    std::size_t n = 0;
    places.fill(Eigen::Vector3d::Zero());
    for (std::ptrdiff_t i = begin; i < end; ++i, ++n) {
      const ScanPoint& point = (*term.points)[static_cast<std::size_t>(i) * stride];
      placed[n].arm = pose_.rotation * sensor.undistorted(point);
      placed[n].place = places[n] = pose_.translation + placed[n].arm;
      placed[n].since_middle = MovingSensor::sinceMiddle(point);
      // At rest a laser draws the same curve again: what is no information about the pose is evidence for it.
      lasers[n] = weighs_evidence_ ? kNoLaser : point.laser;
    }
    term.target->find(places.data(), lasers.data(), n, surfaces.data());
    for (std::size_t i = 0; i < n; ++i) {
      if (surfaces[i].kind == SurfaceKind::plane) {
        addPlane(placed[i], surfaces[i], look, sums);
      } else if (surfaces[i].kind != SurfaceKind::unknown) {
        addLineOrPoint(placed[i], surfaces[i], look, sums);
      }
    }
  }

  /// Eq. 7, and Eq. 14 with the plane's normal.
  void addPlane(const PlacedPoint& p, const Surface& plane, double look, Sums& sums) const
  {
    constexpr double kNoExtent = 1e-9;  // m^2
    const Eigen::Vector3d from_center = p.place - plane.center;
    const double r = plane.direction.dot(from_center);
    const double along = std::max(0.0, from_center.squaredNorm() - r * r);
    const double tilt = along / std::max(plane.extent, kNoExtent);
    const double variance = kRangeNoise * kRangeNoise + plane.thickness * (1.0 + (1.0 + tilt) / plane.count);
    Vector6 row;
    row << plane.direction, p.arm.cross(plane.direction);
    row += p.since_middle * (sweep_gain_.transpose() * row);
    const double w = weight(r * r, variance, doubtOf(row, look), p, sums);
    sums.information += w * row * row.transpose();
    sums.gradient += (w * r) * row;
    ++sums.planes;
  }

  /// Eq. 5 and 13: the distance across a line; to a point, what of it is felt there.
  void addLineOrPoint(const PlacedPoint& p, const Surface& surface, double look, Sums& sums) const
  {
    const bool is_line = surface.kind == SurfaceKind::line;
    const Eigen::Matrix3d felt =
        is_line ? Eigen::Matrix3d::Identity() - surface.direction * surface.direction.transpose() : surface.felt;
    (is_line ? sums.lines : sums.points) += 1;
    const Eigen::Vector3d from_center = p.place - surface.center;
    const Eigen::Vector3d r = felt * from_center;
    const double squared = is_line ? r.squaredNorm() : from_center.squaredNorm();
    Eigen::Matrix<double, 3, 6> rows;
    rows.leftCols<3>().setIdentity();
    rows.rightCols<3>() = -skew(p.arm);
    rows += p.since_middle * (rows * sweep_gain_);
    const double length = is_line ? r.norm() : from_center.norm();
    const Eigen::Vector3d direction =
        length > 0.0 ? Eigen::Vector3d((is_line ? r : from_center) / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const Vector6 row = rows.transpose() * direction;
    const double variance = kRangeNoise * kRangeNoise + surface.thickness;
    const double w = weight(squared, variance, doubtOf(row, look), p, sums);
    sums.information += w * rows.transpose() * felt * rows;
    sums.gradient += w * rows.transpose() * r;
  }

  /// Squared distance by which the point may still be off with the pose along its residual, m^2.
  [[nodiscard]] double doubtOf(const Vector6& row, double look) const
  {
    return kLeastDoubt * kLeastDoubt + look * look * row.dot(problem_.guess_covariance * row);
  }

  [[nodiscard]] double weight(double squared, double variance, double doubt, const PlacedPoint& p, Sums& sums) const
  {
    constexpr double kFits = 3.0;       // standard deviations
    constexpr double kOutliers = 0.01;  // share of the points of which the map knows nothing
    const double width = kKernelWidth * kKernelWidth * (variance + doubt);
    const double ratio = width / (width + squared);
    const double robust = ratio * ratio;
    sums.cost += 0.5 * robust * squared / variance;
    sums.squares += robust * squared;
    sums.weight += robust;
    sums.total += robust / variance;
    sums.squared_extent += robust / variance * p.arm.squaredNorm();
    sums.fits += squared < kFits * kFits * variance ? 1 : 0;
    if (weighs_evidence_) {
      const double density = std::exp(-0.5 * squared / variance) / std::sqrt(2.0 * M_PI * variance);
      sums.evidence += std::log(kOutliers + (1.0 - kOutliers) * density);
    }
    return robust / variance;
  }

  /// The Gauss-Newton step, the guess's own measurement included.
  [[nodiscard]] Vector6 stepOf(const Sums& sums) const
  {
    Vector6 off;
    off.head<3>() = pose_.translation - problem_.guess.translation;
    off.tail<3>() = logSO3(pose_.rotation * problem_.guess.rotation.transpose());
    Eigen::Matrix<double, 6, 6> h = sums.information + prior_;
    Eigen::Matrix<double, 6, 1> b = sums.gradient + prior_ * off;
    for (int i = 0; i < 6; ++i) {
      if (problem_.locked[static_cast<std::size_t>(i)]) {
        h.row(i).setZero();
        h.col(i).setZero();
        h(i, i) = 1.0;
        b[i] = 0.0;
      }
    }
    return -h.ldlt().solve(b);
  }

  const SurfaceProblem& problem_;
  SE3 pose_;
  Matrix6 prior_ = Matrix6::Zero();
  double doubt_;  // m^2, of the guess
  bool weighs_evidence_ = false;
  Eigen::Matrix<double, 6, 6> sweep_gain_ = Eigen::Matrix<double, 6, 6>::Zero();  // in the target's axes
};

}  // namespace

SurfaceRegistration registerSurfaces(const SurfaceProblem& problem)
{
  SurfaceRegistration nothing;
  nothing.report.target_T_source = problem.guess;
  if (problem.scan.target == nullptr || problem.scan.target->empty()) {
    nothing.report.termination = Termination::empty_target;
    return nothing;
  }
  if (!problem.guess.isFinite()) {
    nothing.report.termination = Termination::invalid_input;
    return nothing;
  }
  return PoseEstimation(problem).run();
}

}  // namespace pcl_floam
