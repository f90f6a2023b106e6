#include "registration/surface_registration.h"

#include "map/laser_support.h"
#include "registration/normal_equations.h"
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

/// What many residuals count as one beside what was known before: neighbours share the errors of the map.
constexpr double kResidualsBesideMotion = 3.0;

constexpr std::ptrdiff_t kChunk = 128;

using Square6 = Eigen::Matrix<double, 6, 6>;
using Square12 = Eigen::Matrix<double, 12, 12>;
using Column12 = Eigen::Matrix<double, 12, 1>;

/// H, b (Eq. 10 to 14) and what the report tells, of some of the residuals. The twist of the equations is the velocity.
struct Sums {
  NormalEquations equations;
  double squares = 0.0;
  double robust_weight = 0.0;
  double evidence = 0.0;
  int planes = 0, lines = 0, points = 0, fits = 0;

  [[nodiscard]] int count() const { return planes + lines + points; }

  void addEquations(const Matrix6& h, const Vector6& b, double since_middle)
  {
    equations.information += h;
    equations.coupling += since_middle * h;
    equations.twist_information += since_middle * since_middle * h;
    equations.gradient += b;
    equations.twist_gradient += since_middle * b;
  }

  /// What a normal that is off by \p variance in all directions makes of H: v A A^T with A = (1, arm x).
  void addNormalsNoise(double variance, const Eigen::Vector3d& arm)
  {
    Matrix6& noise = equations.noise_information;
    noise.topLeftCorner<3, 3>().diagonal().array() += variance;
    noise.topRightCorner<3, 3>() -= variance * skew(arm);
    noise.bottomLeftCorner<3, 3>() += variance * skew(arm);
    noise.bottomRightCorner<3, 3>() +=
        variance * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }

  void add(const Sums& other)
  {
    equations.information += other.equations.information;
    equations.noise_information += other.equations.noise_information;
    equations.coupling += other.equations.coupling;
    equations.twist_information += other.equations.twist_information;
    equations.gradient += other.equations.gradient;
    equations.twist_gradient += other.equations.twist_gradient;
    equations.cost += other.equations.cost;
    equations.weight += other.equations.weight;
    equations.squared_extent += other.equations.squared_extent;
    squares += other.squares;
    robust_weight += other.robust_weight;
    evidence += other.evidence;
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
  double since_middle = 0.0;                        ///< in periods: so much of a change of the velocity moves it, too
};

class PoseEstimation {
public:
  explicit PoseEstimation(const SurfaceProblem& problem)
      : problem_(problem),
        pose_(problem.prior.pose),
        velocity_(problem.prior.velocity),
        prior_(priorInformation(problem.prior)),
        doubt_(problem.reach.topLeftCorner<3, 3>().trace())
  {
  }

  SurfaceRegistration run()
  {
    SurfaceRegistration result;
    Sums sums = iterate(result.report);
    if (problem_.looks_for_weak && result.report.hasConverged() && findWeakDirections(sums.equations)) {
      pose_ = problem_.prior.pose;
      velocity_ = problem_.prior.velocity;
      sums = iterate(result.report);
    }
    conclude(result, sums);
    if (problem_.wants_evidence && result.report.hasConverged()) {
      weighs_evidence_ = true;
      result.evidence = accumulate(0.0, 1).evidence;
    }
    return result;
  }

private:
  Sums iterate(RegistrationReport& report)
  {
    report.termination = Termination::iteration_limit;
    Sums sums;
    double look = kFirstLook;
    for (int i = 0; i < problem_.max_iterations && report.hasConverged(); ++i, look *= 0.5) {
      const bool narrow = look * look * doubt_ <= kLeastDoubt * kLeastDoubt;
      const bool all = narrow || i >= kFewestIterations || problem_.scan.points->size() < kManyPoints;
      sums = accumulate(look, all ? 1 : kFirstStride);
      report.iterations = i + 1;
      const Column12 step = sums.count() < kFewest ? Column12(Column12::Zero()) : stepOf(sums);
      if (sums.count() < kFewest) {
        report.termination = Termination::too_few_correspondences;
      } else if (!step.allFinite()) {
        report.termination = Termination::degenerate;
      } else if (take(step, sums) && narrow && i + 1 >= kFewestIterations) {
        report.termination = Termination::converged;
        break;
      }
    }
    return sums;
  }

  /// By how much the velocity follows the pose, and how well it is known then; and how well the pose is known.
  [[nodiscard]] static Square12 priorInformation(const SweepPrior& prior)
  {
    constexpr double kNothingKnown = 1e-6;  // 1/m^2 and 1/rad^2: a kilometre
    constexpr double kLeastVariance = 1e-12;
    const Square12 covariance = prior.covariance;
    const Square6 pose = covariance.topLeftCorner<6, 6>() + kLeastVariance * Square6::Identity();
    const Square6 gain = pose.ldlt().solve(Square6(covariance.topRightCorner<6, 6>())).transpose();
    const Square6 rest = covariance.bottomRightCorner<6, 6>() - gain * covariance.topRightCorner<6, 6>() +
                         kLeastVariance * Square6::Identity();
    const Square6 known = rest.inverse();
    Square12 information;
    information << gain.transpose() * known * gain, -gain.transpose() * known, -known * gain, known;
    information.topLeftCorner<6, 6>() +=
        prior.pose_counts ? Square6(pose.inverse()) : Square6(kNothingKnown * Square6::Identity());
    return information;
  }

  /// \return whether it was a small step
  bool take(const Column12& step, const Sums& sums)
  {
    const Vector6 motion = step.head<6>();
    const Eigen::Matrix3d back = pose_.rotation.transpose();
    velocity_.head<3>() += back * step.segment<3>(6);
    velocity_.tail<3>() += back * step.segment<3>(9);
    pose_.translation += motion.head<3>();
    pose_.rotation = nearestRotation(expSO3(motion.tail<3>()) * pose_.rotation);
    const Vector6 seen = sums.equations.information * motion;
    return motion.dot(seen) < kSmallStep * kSmallStep * kResidualsPerIndependentOne;
  }

  void conclude(SurfaceRegistration& result, const Sums& sums)
  {
    RegistrationReport& report = result.report;
    report.weak_directions = weak_;
    report.target_T_source = report.hasConverged() ? pose_ : problem_.prior.pose;
    report.sweep_twist = twist();
    report.sweep_acceleration = acceleration();
    report.edge_correspondences = sums.lines;
    report.plane_correspondences = sums.planes;
    report.point_correspondences = sums.points;
    report.plane_inliers = sums.fits;
    report.information = strong_.transpose() * sums.equations.information * strong_;
    report.cost = sums.equations.cost;
    report.residual_rms = sums.robust_weight > 0.0 ? std::sqrt(sums.squares / sums.robust_weight) : 0.0;
    result.posterior = posteriorOf(sums);
    report.covariance = result.posterior.topLeftCorner<6, 6>();
    result.velocity = velocity_;
    result.points = problem_.scan.points->size();
  }

  [[nodiscard]] Square12 posteriorOf(const Sums& sums) const
  {
    const Equations equations = equationsOf(sums);
    Square12 covariance = equations.information.inverse();
    for (int i = 0; i < 12; ++i) {
      if (isLocked(i)) {
        covariance.row(i).setZero();
        covariance.col(i).setZero();
      }
    }
    return covariance;
  }

  [[nodiscard]] bool isLocked(int i) const { return problem_.locked[static_cast<std::size_t>(i % 6)]; }

  /// Those along which no more is told than noise of the planes' normals would, so that it follows the sensor wherever
  /// it goes. Along them the pose is left to the prior (solution remapping after Zhang and Singh, 2016). They are
  /// eigenvectors of H itself, unlike InformationAnalysis's: without them H says exactly nothing of what is not seen.
  bool findWeakDirections(const NormalEquations& e)
  {
    constexpr double kNothing = 1e-6;  // of residuals that tell of the direction alone
    if (!(e.squared_extent > 0.0)) {
      return false;
    }
    const double per_metre = std::sqrt(e.weight / e.squared_extent);
    Vector6 scale;
    scale << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
    const auto scaled = [&](const Matrix6& m) {
      return Square6(scale.asDiagonal() * m * scale.asDiagonal() / e.weight);
    };
    const Square6 noise = scaled(e.noise_information);
    const Eigen::SelfAdjointEigenSolver<Square6> solver(scaled(e.information));
    Square6 strong = Square6::Identity();
    for (int i = 0; i < 6; ++i) {
      const Eigen::Matrix<double, 6, 1> direction = solver.eigenvectors().col(i);
      const double told = std::max(0.0, solver.eigenvalues()[i]);
      if (told < direction.dot(noise * direction) + kNothing) {
        weak_.push_back({direction, told});
        strong -= direction * direction.transpose();
      }
    }
    strong_ = scale.asDiagonal() * strong * scale.cwiseInverse().asDiagonal();
    return !weak_.empty();
  }

  [[nodiscard]] Vector6 twist() const { return problem_.prior.fraction * placingVelocity(); }

  [[nodiscard]] Vector6 placingVelocity() const
  {
    return problem_.placement == SweepPlacement::held ? problem_.prior.velocity : velocity_;
  }

  /// Over the sweep, from how the velocity has changed since the last one.
  [[nodiscard]] Vector6 acceleration() const
  {
    const SweepPrior& prior = problem_.prior;
    return prior.periods_between > 0.0 ? Vector6(prior.fraction * prior.fraction / prior.periods_between *
                                                 (placingVelocity() - prior.velocity_before))
                                       : Vector6(Vector6::Zero());
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
    const MovingSensor sensor(pose_, twist(), acceleration());
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
    const double slope = problem_.placement == SweepPlacement::joint ? problem_.prior.fraction : 0.0;
    places.fill(Eigen::Vector3d::Zero());
    for (std::ptrdiff_t i = begin; i < end; ++i, ++n) {
      const ScanPoint& point = (*term.points)[static_cast<std::size_t>(i) * stride];
      placed[n].arm = pose_.rotation * sensor.undistorted(point);
      placed[n].place = places[n] = pose_.translation + placed[n].arm;
      placed[n].since_middle = slope * MovingSensor::sinceMiddle(point);
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
    const double w = weight(r * r, variance, doubtOf(row, look), p, sums);
    sums.addEquations(w * row * row.transpose(), (w * r) * row, p.since_middle);
    // Three points go into the plane; its thickness is what noise leaves to the others.
    const double noise = plane.thickness + 3.0 * kRangeNoise * kRangeNoise / plane.count;
    sums.addNormalsNoise(w * noise / (plane.count * std::max(plane.extent, kNoExtent)), p.arm);
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
    const double length = is_line ? r.norm() : from_center.norm();
    const Eigen::Vector3d direction =
        length > 0.0 ? Eigen::Vector3d((is_line ? r : from_center) / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const Vector6 row = rows.transpose() * direction;
    const double variance = kRangeNoise * kRangeNoise + surface.thickness;
    const double w = weight(squared, variance, doubtOf(row, look), p, sums);
    sums.addEquations(w * rows.transpose() * felt * rows, w * rows.transpose() * r, p.since_middle);
  }

  /// Squared distance by which the point may still be off with the pose along its residual, m^2.
  [[nodiscard]] double doubtOf(const Vector6& row, double look) const
  {
    return kLeastDoubt * kLeastDoubt + look * look * row.dot(problem_.reach * row);
  }

  [[nodiscard]] double weight(double squared, double variance, double doubt, const PlacedPoint& p, Sums& sums) const
  {
    constexpr double kFits = 3.0;       // standard deviations
    constexpr double kOutliers = 0.01;  // share of the points of which the map knows nothing
    const double width = kKernelWidth * kKernelWidth * (variance + doubt);
    const double ratio = width / (width + squared);
    const double robust = ratio * ratio;
    sums.equations.cost += 0.5 * robust * squared / variance;
    sums.equations.weight += robust / variance;
    sums.equations.squared_extent += robust / variance * p.arm.squaredNorm();
    sums.squares += robust * squared;
    sums.robust_weight += robust;
    sums.fits += squared < kFits * kFits * variance ? 1 : 0;
    if (weighs_evidence_) {
      const double density = std::exp(-0.5 * squared / variance) / std::sqrt(2.0 * M_PI * variance);
      sums.evidence += std::log(kOutliers + (1.0 - kOutliers) * density);
    }
    return robust / variance;
  }

  struct Equations {
    Square12 information;
    Column12 gradient;
  };

  /// Of pose and velocity: what the residuals say, as so many independent ones, and what was known before.
  [[nodiscard]] Equations equationsOf(const Sums& sums) const
  {
    const NormalEquations& e = sums.equations;
    const auto cleaned = [&](const Matrix6& m) { return Square6(strong_.transpose() * m * strong_); };
    Column12 off;
    off.head<3>() = pose_.translation - problem_.prior.pose.translation;
    off.segment<3>(3) = logSO3(pose_.rotation * problem_.prior.pose.rotation.transpose());
    const Vector6 faster = velocity_ - problem_.prior.velocity;
    off.segment<3>(6) = pose_.rotation * faster.head<3>();
    off.segment<3>(9) = pose_.rotation * faster.tail<3>();
    Equations equations;
    equations.information << cleaned(e.information), cleaned(e.coupling), cleaned(e.coupling),
        cleaned(e.twist_information);
    equations.information /= kResidualsBesideMotion;
    equations.information += prior_;
    equations.gradient << strong_.transpose() * e.gradient, strong_.transpose() * e.twist_gradient;
    equations.gradient /= kResidualsBesideMotion;
    equations.gradient += prior_ * off;
    for (int i = 0; i < 12; ++i) {
      if (isLocked(i)) {
        equations.information.row(i).setZero();
        equations.information.col(i).setZero();
        equations.information(i, i) = 1.0;
        equations.gradient[i] = 0.0;
      }
    }
    return equations;
  }

  [[nodiscard]] Column12 stepOf(const Sums& sums) const
  {
    const Equations equations = equationsOf(sums);
    return -equations.information.ldlt().solve(equations.gradient);
  }

  const SurfaceProblem& problem_;
  SE3 pose_;
  Vector6 velocity_;  // per period, in the sensor's axes
  Square12 prior_;
  double doubt_;  // m^2, of the guess
  bool weighs_evidence_ = false;
  std::vector<WeakDirection> weak_;
  Square6 strong_ = Square6::Identity();  // projects on all other directions
};

}  // namespace

SurfaceRegistration registerSurfaces(const SurfaceProblem& problem)
{
  SurfaceRegistration nothing;
  nothing.report.target_T_source = problem.prior.pose;
  if (problem.scan.target == nullptr || problem.scan.target->empty()) {
    nothing.report.termination = Termination::empty_target;
    return nothing;
  }
  if (!problem.prior.pose.isFinite()) {
    nothing.report.termination = Termination::invalid_input;
    return nothing;
  }
  return PoseEstimation(problem).run();
}

}  // namespace pcl_floam
