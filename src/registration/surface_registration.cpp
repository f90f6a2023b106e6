#include "registration/surface_registration.h"

#include "registration/locked_motions.h"
#include "registration/net_information.h"
#include "registration/sampling_pattern.h"
#include "registration/surface_evidence.h"
#include "registration/surface_residuals.h"
#include "registration/sweep_estimate.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace pcl_floam {

namespace {

/// What a pose may be off where nothing is known against it, m.
constexpr double kLeastDoubt = 0.02;
/// The first iterations, which look far, are coarse: at least and at most so many.
constexpr int kLeastFirst = 2;
constexpr int kMostFirst = 4;
/// Correspondences that are needed for a pose.
constexpr int kFewest = 20;
/// A step that ends the iterations, in standard deviations of the pose by what counts as independent residuals.
constexpr double kSmallStep = 0.3;

/// As many residuals count as one beside what was known before: neighbours share the errors of the map.
constexpr double kResidualsBesideMotion = 3.0;

/// m^2, of where the guess has the points. Rivals look farther than their guesses may be off as it is.
double squaredDoubt(const SurfaceProblem& problem)
{
  const double range = problem.is_rival ? 0.0 : rmsRange(*problem.scan.points);
  return problem.guess_covariance.topLeftCorner<3, 3>().trace() +
         range * range * problem.guess_covariance.bottomRightCorner<3, 3>().trace();
}

class PoseEstimation {
public:
  explicit PoseEstimation(const SurfaceProblem& problem)
      : problem_(problem),
        of_prior_(problem.prior.information()),
        prior_(of_prior_),
        doubt_(squaredDoubt(problem)),
        first_stride_(coarseStride(problem.scan)),
        placing_(problem.prior, problem.placement),
        room_(problem.room != nullptr ? *problem.room : own_room_)
  {
    const SweepPrior::State begin = problem.prior.movedBy(problem.begins_off);
    at_ = {begin.pose, begin.velocity};
    room_.edges.assign(problem.edges.points != nullptr ? problem.edges.points->size() : 0, FoundSurface());
  }

  SurfaceRegistration run()
  {
    SurfaceRegistration result;
    SurfaceSums sums = iterate(result.report, 1.0);
    if (problem_.looks_for_patterns && result.report.hasConverged()) {
      findPatterns();
      if (left_to_prior_.cols() > 0) {
        sums = iterate(result.report, 0.0);
      }
    }
    if (problem_.evidence != Evidence::none && result.report.hasConverged()) {
      weighEvidence(result);
    }
    conclude(result, sums);
    return result;
  }

private:
  /// What only patterns tell is left to a hint, if one tells of it. Otherwise the pose stays where it is, though
  /// nothing is known of that: what is expected would be no more than what the pattern has told before.
  void findPatterns()
  {
    const auto pulls = [this](const TriedMotions& motions, const Vector6& moved) {
      SweepEstimate there = at_;
      there.move(moved);
      return residualsAt(there, moved * moved.transpose()).pullsAlong(motions, problem_.scan, problem_.edges, room_);
    };
    const Matrix6 information = propagated(strong_.transpose(), net_) / kResidualsBesideMotion;
    by_pattern_ = motionsToldByPattern(information, problem_.locked, pulls);
    left_to_prior_ = knownAmong(by_pattern_, problem_.prior.hinted);
  }

  void weighEvidence(SurfaceRegistration& result)
  {
    const SurfaceEvidence evidence{placing_.trajectory(at_), problem_.threads};
    std::vector<float>* of_points = problem_.evidence == Evidence::of_points ? &result.point_evidence : nullptr;
    result.evidence = evidence.of(problem_.scan, problem_.edges, room_.edges, of_points);
  }

  /// \param look of what the guess may be off, so far: halved with each
  SurfaceSums iterate(RegistrationReport& report, double look)
  {
    report.termination = Termination::iteration_limit;
    SurfaceSums sums;
    for (int i = 0; i < problem_.max_iterations && report.hasConverged(); ++i, look *= 0.5) {
      const bool narrow = look * look * doubt_ <= kLeastDoubt * kLeastDoubt;
      const bool all = first_stride_ == 1 || i >= kMostFirst || (narrow && i >= kLeastFirst);
      sums = told(sumsAt(look, all ? 1 : first_stride_));
      ++report.iterations;
      const Vector12 step = sums.equations.count() < kFewest ? Vector12(Vector12::Zero()) : stepOf(sums);
      if (sums.equations.count() < kFewest) {
        report.termination = Termination::too_few_correspondences;
      } else if (!step.allFinite()) {
        report.termination = Termination::degenerate;
      } else if (take(step, sums) && narrow && all) {
        report.termination = Termination::converged;
        break;
      }
    }
    return sums;
  }

  /// \return whether it was a small step
  bool take(const Vector12& step, const SurfaceSums& sums)
  {
    at_.take(step);
    const Vector6 motion = step.head<6>();
    return motion.dot(sums.equations.information * motion) < kSmallStep * kSmallStep * kResidualsPerIndependentOne;
  }

  void conclude(SurfaceRegistration& result, const SurfaceSums& sums)
  {
    RegistrationReport& report = result.report;
    if (report.hasConverged()) {
      report.weak_directions = weak_;
    }
    report.target_T_source = report.hasConverged() ? at_.pose : problem_.prior.pose;
    report.sweep_twist = placing_.twist(at_);
    report.sweep_acceleration = placing_.acceleration(at_);
    report.edge_correspondences = sums.equations.edges;
    report.plane_correspondences = sums.equations.planes;
    report.point_correspondences = sums.equations.points;
    report.plane_inliers = sums.equations.plane_inliers;
    report.information = propagated(strong_.transpose(), sums.equations.information);
    const Matrix6 besides = this->besides().information;
    const Matrix6 told = propagated(apartFrom(by_pattern_, strong_, net_).transpose(), net_) / kResidualsBesideMotion;
    result.told = covarianceBy(told + besides);
    addToWeak(by_pattern_, besides, commonUnits(sums.equations), report.weak_directions);
    report.cost = sums.equations.cost;
    report.residual_rms =
        sums.robust_weight > 0.0 ? std::sqrt(sums.equations.weighted_squares / sums.robust_weight) : 0.0;
    result.posterior = posterior();
    report.covariance = result.posterior.topLeftCorner<6, 6>();
    result.velocity = at_.velocity;
    result.points =
        problem_.scan.points->size() + (problem_.edges.points != nullptr ? problem_.edges.points->size() : 0);
  }

  /// What else is known of the pose.
  [[nodiscard]] PoseEquations besides() const
  {
    return problem_.factors != nullptr ? problem_.factors->at(at_.pose) : PoseEquations();
  }

  /// As residuals would tell of it: by factors, and, as well as all residuals together, of what is locked.
  [[nodiscard]] Matrix6 toldElsewhere(const NormalEquations& all) const
  {
    Matrix6 told = kResidualsBesideMotion * besides().information;
    if (!(all.squared_extent > 0.0)) {
      return told;
    }
    const Vector6 units = commonUnits(all);
    for (int i = 0; i < 6; ++i) {
      told(i, i) += isLocked(problem_.locked, i) ? all.weight / (units[i] * units[i]) : 0.0;
    }
    return told;
  }

  /// Of the pose, whatever was expected.
  [[nodiscard]] Matrix6 covarianceBy(const Matrix6& information) const
  {
    Matrix6 known = information;
    known.diagonal().array() += kNothingKnown;
    return covarianceWithLocked(inverseOf(informationWithLocked(known, problem_.locked)), problem_.locked);
  }

  /// Symmetric to the bit: it is the next sweep's prior, and what rounding left would grow from sweep to sweep.
  [[nodiscard]] Matrix12 posterior() const
  {
    const Matrix12 covariance = inverseOf(equationsOf(known_).information);
    return covarianceWithLocked(Matrix12(0.5 * (covariance + covariance.transpose())), problem_.locked);
  }

  /// What points and edges tell, each beyond their noise: noise of the one does not make the other less. Along a motion
  /// of which they tell next to nothing the pose is left to the prior, and so it is not corrected by what is seen of
  /// others: how far the sensor has gone unseen is known worse than in which direction, and that worse than where the
  /// walls are.
  SurfaceSums told(const SweepSums& sums)
  {
    SurfaceSums told = sums.total();
    known_ = told.equations;
    NetEquations net = withoutNoise(sums.scan.equations);
    net += withoutNoise(sums.edges.equations);
    net_ = net.steps.information;
    const UntoldMotions untold = untoldMotions(net.steps, told.equations, toldElsewhere(told.equations));
    if (!problem_.is_rival) {
      told.equations = net.steps;
      known_ = net.known;
    }
    strong_ = apartFrom(left_to_prior_, Matrix6::Identity() - untold.onto, net_);
    weak_ = untold.directions;
    const Motions left = orthonormalBeside(Motions(6, 0), left_to_prior_);
    const Matrix6 onto = untold.onto + Matrix6(left * left.transpose()) * (Matrix6::Identity() - untold.onto);
    prior_ = onto.isZero(0.0) ? of_prior_ : problem_.prior.apartFrom(onto).information();
    return told;
  }

  /// \param uncertainty of the pose
  [[nodiscard]] SurfaceResiduals residualsAt(const SweepEstimate& at, const Matrix6& uncertainty) const
  {
    SurfaceResiduals residuals{placing_.trajectory(at)};
    residuals.pose_uncertainty = uncertainty;
    residuals.pose_uncertainty.topLeftCorner<3, 3>().diagonal().array() += kLeastDoubt * kLeastDoubt;
    residuals.periods = problem_.placement == SweepPlacement::joint ? problem_.prior.fraction : 0.0;
    residuals.threads = problem_.threads;
    return residuals;
  }

  [[nodiscard]] SweepSums sumsAt(double look, std::size_t stride)
  {
    const std::size_t edge_stride = problem_.is_rival ? 1 : stride;  // between motions, few edges tell
    return residualsAt(at_, look * look * problem_.guess_covariance)
        .sumsOf(problem_.scan, stride, problem_.edges, edge_stride, room_);
  }

  struct Equations {
    Matrix12 information;
    Vector12 gradient;
  };

  /// Of pose and velocity: what the residuals say, as so many independent ones, and what was known before.
  [[nodiscard]] Equations equationsOf(const NormalEquations& e) const
  {
    const auto cleaned = [&](const Matrix6& m) { return propagated(strong_.transpose(), m); };
    Equations equations;
    equations.information << cleaned(e.information), cleaned(e.coupling), cleaned(e.coupling),
        cleaned(e.twist_information);
    equations.information /= kResidualsBesideMotion;
    equations.information += prior_;
    equations.gradient << strong_.transpose() * e.gradient, strong_.transpose() * e.twist_gradient;
    equations.gradient /= kResidualsBesideMotion;
    equations.gradient += prior_ * problem_.prior.offset(at_.pose, at_.velocity);
    const PoseEquations besides = this->besides();
    equations.information.topLeftCorner<6, 6>() += besides.information;
    equations.gradient.head<6>() += besides.gradient;
    equations.information = informationWithLocked(equations.information, problem_.locked);
    for (int i = 0; i < 12; ++i) {
      equations.gradient[i] = isLocked(problem_.locked, i) ? 0.0 : equations.gradient[i];
    }
    return equations;
  }

  [[nodiscard]] Vector12 stepOf(const SurfaceSums& sums) const
  {
    const Equations equations = equationsOf(sums.equations);
    return -equations.information.ldlt().solve(equations.gradient);
  }

  const SurfaceProblem& problem_;
  SweepEstimate at_;
  const Matrix12 of_prior_;
  Matrix12 prior_;  // apart from what is not told
  double doubt_;    // m^2, of the guess
  std::size_t first_stride_;
  SweepPlacing placing_;
  SurfaceRoom own_room_;
  SurfaceRoom& room_;
  NormalEquations known_;  // of the last iteration
  Matrix6 net_ = Matrix6::Zero();
  Motions by_pattern_ = Motions(6, 0);  // told by nothing else
  Motions left_to_prior_ = Motions(6, 0);
  std::vector<WeakDirection> weak_;
  Matrix6 strong_ = Matrix6::Identity();  // projects on all other directions
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
