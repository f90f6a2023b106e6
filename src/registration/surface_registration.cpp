#include "registration/surface_registration.h"

#include "registration/sweep_points.h"

#include <Eigen/Cholesky>
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
/// A step that ends the iterations, m and rad.
constexpr double kSmallStep = 1e-3;
constexpr double kSmallTurn = 1e-4;
constexpr int kFewestIterations = 4;

constexpr std::ptrdiff_t kChunk = 128;

/// H, b and what the report tells, of some of the residuals (Eq. 10 to 14).
struct Sums {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double cost = 0.0;
  double squares = 0.0;
  double weight = 0.0;
  int planes = 0, lines = 0, points = 0, fits = 0;

  [[nodiscard]] int count() const { return planes + lines + points; }

  void add(const Sums& other)
  {
    information += other.information;
    gradient += other.gradient;
    cost += other.cost;
    squares += other.squares;
    weight += other.weight;
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
  double gain = 1.0;  ///< by how much it moves with the pose: 1 + u where the sweep's motion follows from the pose
};

class PoseEstimation {
public:
  explicit PoseEstimation(const SurfaceProblem& problem)
      : problem_(problem),
        pose_(problem.guess),
        translation_variance_(problem.guess_covariance.topLeftCorner<3, 3>().trace()),
        rotation_variance_(problem.guess_covariance.bottomRightCorner<3, 3>().trace())
  {
    if (problem.guess_is_prior) {
      const Eigen::Matrix<double, 6, 6> covariance = problem.guess_covariance;
      prior_ = covariance.inverse();
    }
  }

  RegistrationReport run()
  {
    RegistrationReport report;
    report.termination = Termination::iteration_limit;
    Sums sums;
    double look = kFirstLook;
    for (int i = 0; i < problem_.max_iterations && report.hasConverged(); ++i, look *= 0.5) {
      const bool narrow = look * look * translation_variance_ <= kLeastDoubt * kLeastDoubt;
      const bool all = narrow || i >= kFewestIterations || problem_.points->size() < kManyPoints;
      sums = accumulate(look, all ? 1 : kFirstStride);
      report.iterations = i + 1;
      const Vector6 step = sums.count() < kFewest ? Vector6(Vector6::Zero()) : stepOf(sums);
      if (sums.count() < kFewest) {
        report.termination = Termination::too_few_correspondences;
      } else if (!step.allFinite()) {
        report.termination = Termination::degenerate;
      } else if (take(step) && all && i + 1 >= kFewestIterations) {
        report.termination = Termination::converged;
        break;
      }
    }
    return conclude(report, sums);
  }

private:
  /// \return whether it was a small step
  bool take(const Vector6& step)
  {
    pose_.translation += step.head<3>();
    pose_.rotation = nearestRotation(expSO3(step.tail<3>()) * pose_.rotation);
    return step.head<3>().norm() < kSmallStep && step.tail<3>().norm() < kSmallTurn;
  }

  RegistrationReport conclude(RegistrationReport& report, const Sums& sums) const
  {
    report.target_T_source = report.hasConverged() ? pose_ : problem_.guess;
    report.sweep_twist = sweepTwist();
    report.edge_correspondences = sums.lines;
    report.plane_correspondences = sums.planes;
    report.point_correspondences = sums.points;
    report.plane_inliers = sums.fits;
    report.information = sums.information;
    report.cost = sums.cost;
    report.residual_rms = sums.weight > 0.0 ? std::sqrt(sums.squares / sums.weight) : 0.0;
    constexpr double kNothingKnown = 1e-6;  // 1/m^2 and 1/rad^2: a kilometre
    const Eigen::Matrix<double, 6, 6> information =
        sums.information + prior_ + kNothingKnown * Matrix6(Matrix6::Identity());
    report.covariance = information.inverse();
    return report;
  }

  [[nodiscard]] Vector6 sweepTwist() const
  {
    if (problem_.sweep_per_motion > 0.0) {
      return problem_.sweep_per_motion * log(problem_.earlier_pose.inverse() * pose_);
    }
    return problem_.sweep_twist;
  }

  /// In fixed chunks, added in order: the same bits for every number of threads.
  [[nodiscard]] Sums accumulate(double look, std::size_t stride) const
  {
    const MovingSensor sensor(pose_, sweepTwist());
    const auto count = static_cast<std::ptrdiff_t>((problem_.points->size() + stride - 1) / stride);
    const std::ptrdiff_t chunks = (count + kChunk - 1) / kChunk;
    std::vector<Sums> parts(static_cast<std::size_t>(chunks));
#pragma omp parallel for num_threads(problem_.threads) schedule(dynamic)
    for (std::ptrdiff_t c = 0; c < chunks; ++c) {
      addChunk(sensor, c * kChunk, std::min(count, (c + 1) * kChunk), stride, look, parts[static_cast<std::size_t>(c)]);
    }
    Sums sums;
    for (const Sums& part : parts) {
      sums.add(part);
    }
    return sums;
  }

  void addChunk(const MovingSensor& sensor, std::ptrdiff_t begin, std::ptrdiff_t end, std::size_t stride, double look,
                Sums& sums) const
  {
    std::array<Eigen::Vector3d, kChunk> places;
    std::array<PlacedPoint, kChunk> placed;
    std::array<Surface, kChunk> surfaces;
    std::size_t n = 0;
    places.fill(Eigen::Vector3d::Zero());
    for (std::ptrdiff_t i = begin; i < end; ++i, ++n) {
      const ScanPoint& point = (*problem_.points)[static_cast<std::size_t>(i) * stride];
      placed[n].arm = pose_.rotation * sensor.undistorted(point);
      placed[n].place = places[n] = pose_.translation + placed[n].arm;
      placed[n].gain = 1.0 + MovingSensor::sinceMiddle(point) * problem_.sweep_per_motion;
    }
    problem_.target->find(places.data(), n, surfaces.data());
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
    row *= p.gain;
    const double w = weight(r * r, variance, doubtOf(p, look), sums);
    sums.information += w * row * row.transpose();
    sums.gradient += (w * r) * row;
    ++sums.planes;
  }

  /// Eq. 5 and 13: the distance across a line; to a point, all of it.
  void addLineOrPoint(const PlacedPoint& p, const Surface& surface, double look, Sums& sums) const
  {
    Eigen::Matrix3d across = Eigen::Matrix3d::Identity();
    if (surface.kind == SurfaceKind::line) {
      across -= surface.direction * surface.direction.transpose();
      ++sums.lines;
    } else {
      ++sums.points;
    }
    const Eigen::Vector3d r = across * (p.place - surface.center);
    Eigen::Matrix<double, 3, 6> rows;
    rows.leftCols<3>() = p.gain * across;
    rows.rightCols<3>() = -p.gain * across * skew(p.arm);
    const double variance = kRangeNoise * kRangeNoise + surface.thickness;
    const double w = weight(r.squaredNorm(), variance, doubtOf(p, look), sums);
    sums.information += w * rows.transpose() * rows;
    sums.gradient += w * rows.transpose() * r;
  }

  /// Squared distance by which the point may still be off with the pose, m^2.
  [[nodiscard]] double doubtOf(const PlacedPoint& p, double look) const
  {
    return kLeastDoubt * kLeastDoubt + look * look * (translation_variance_ + p.arm.squaredNorm() * rotation_variance_);
  }

  static double weight(double squared, double variance, double doubt, Sums& sums)
  {
    constexpr double kFits = 3.0;  // standard deviations
    const double width = kKernelWidth * kKernelWidth * (variance + doubt);
    const double ratio = width / (width + squared);
    const double robust = ratio * ratio;
    sums.cost += 0.5 * robust * squared / variance;
    sums.squares += robust * squared;
    sums.weight += robust;
    sums.fits += squared < kFits * kFits * variance ? 1 : 0;
    return robust / variance;
  }

  /// The Gauss-Newton step, the guess's own measurement included.
  [[nodiscard]] Vector6 stepOf(const Sums& sums) const
  {
    Vector6 off;
    off.head<3>() = pose_.translation - problem_.guess.translation;
    off.tail<3>() = logSO3(pose_.rotation * problem_.guess.rotation.transpose());
    const Eigen::Matrix<double, 6, 6> h = sums.information + prior_;
    const Eigen::Matrix<double, 6, 1> b = sums.gradient + prior_ * off;
    return -h.ldlt().solve(b);
  }

  const SurfaceProblem& problem_;
  SE3 pose_;
  Matrix6 prior_ = Matrix6::Zero();
  double translation_variance_;
  double rotation_variance_;
};

}  // namespace

RegistrationReport registerSurfaces(const SurfaceProblem& problem)
{
  if (problem.target == nullptr || problem.target->empty()) {
    RegistrationReport report;
    report.termination = Termination::empty_target;
    report.target_T_source = problem.guess;
    return report;
  }
  return PoseEstimation(problem).run();
}

}  // namespace pcl_floam
