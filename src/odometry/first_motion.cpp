#include "odometry/first_motion.h"

#include "odometry/best_fit.h"
#include "registration/feature_sampling.h"

#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/registration/feature_registration.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pcl_floam {

namespace {

/// A motion that both scans were compensated with, and what their registration made of it.
struct Candidate {
  Vector6 twist = Vector6::Zero();  ///< per period, estimated
  RegistrationReport report;

  [[nodiscard]] int correspondences() const { return report.edge_correspondences + report.plane_correspondences; }
};

/// Two scans a motion apart, and distorted by it: every landmark is needed, and none is good to millimetres.
///
/// The settings for the rest of the way hold edges for imprecise, and would miss the motion where they alone tell it.
RegistrationParameters forTheStart(RegistrationParameters parameters)
{
  parameters.edge_weight = std::max(0.5, parameters.edge_weight);
  parameters.kernel_scale = std::max(0.1, parameters.kernel_scale);
  parameters.plane_scatter = 0.0;
  parameters.plane_ratio = std::min(3.0, parameters.plane_ratio);
  return parameters;
}

/// Neither scan's distortion is known, so that the map, too, is distorted: both are compensated and registered in turn
/// until they agree.
class FirstMotionSearch {
public:
  FirstMotionSearch(const FirstScans& scans, const OdometryParameters& parameters)
      : scans_(scans),
        parameters_(parameters),
        registration_(forTheStart(parameters.registration)),
        map_(parameters.map),
        sample_(spreadSample(scans.second))
  {
  }

  std::optional<FirstMotion> run(RegistrationReport& report)
  {
    const Candidate start = bestStart();
    report = start.report;
    if (!report.hasConverged()) {
      return std::nullopt;
    }
    const Candidate agreed = refined(start.twist, registration_, Features::spread);
    report = agreed.report;
    if (!report.hasConverged()) {
      return std::nullopt;
    }
    FirstMotion motion;
    motion.twist = refinedNearby(agreed, report).twist;
    motion.others = othersThan(motion.twist, start);
    return motion;
  }

private:
  /// Which features of a scan are registered. What is found with spread ones, of which traffic has its share only,
  /// must not end with the traffic after all.
  enum class Features : std::uint8_t { all, spread };

  /// Compensates and registers until the scans agree on the motion.
  Candidate refined(const Vector6& twist, const RegistrationParameters& registration, Features features)
  {
    constexpr int kMaxRounds = 8;
    Candidate candidate;
    candidate.twist = twist;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Vector6 tried = candidate.twist;
      candidate = tryMotion(scans_.second, tried, 0.0, registration, features);
      if (!candidate.report.hasConverged() || (candidate.twist - tried).norm() < 1e-3 || scans_.sweep_fraction == 0.0) {
        break;
      }
    }
    return candidate;
  }

  /// Once both scans are undistorted, their good planes tell more than all their landmarks: this alone brought 40
  /// starts along simulated corridors and tunnels from 2.0 to 1.4 cm, the mean of the greatest errors in height of
  /// their first ten scans.
  Candidate refinedNearby(const Candidate& start, RegistrationReport& report)
  {
    constexpr double kNear = 0.1;           // m per period
    constexpr double kNearlyTurned = 0.02;  // rad per period
    Candidate fine = refined(start.twist, parameters_.registration, Features::all);
    const Vector6 change = fine.twist - start.twist;
    if (!fine.report.hasConverged() || change.head<3>().norm() > kNear || change.tail<3>().norm() > kNearlyTurned) {
      return start;
    }
    report = fine.report;
    return fine;
  }

  /// A start in motion among vehicles of the same speed: their few but dense points, seen from rest, agree well with
  /// no motion at all, and the landmarks, distorted by metres, with nothing. So fast motions in all directions are
  /// tried, too, and one of them is taken if it explains the scans clearly better than what was found from rest
  /// (simulated highways at 25 m/s: residuals of 2.9 against 5.0 cm, say).
  const Candidate& bestStart()
  {
    constexpr double kFarthestFromRest = 4.0;  // m
    RegistrationParameters rough = registration_;
    tried_.push_back(tryMotion(sample_, Vector6::Zero(), kFarthestFromRest, rough));
    constexpr int kRoughIterations = 10;
    rough.max_iterations = std::min(rough.max_iterations, kRoughIterations);
    for (const double metres_per_period : {1.5, 3.0}) {
      constexpr int kDirections = 8;
      for (int direction = 0; direction < kDirections; ++direction) {
        const double angle = 2.0 * M_PI * direction / kDirections;
        Vector6 twist = Vector6::Zero();
        twist.head<2>() << metres_per_period * std::cos(angle), metres_per_period * std::sin(angle);
        for (int axis = 0; axis < 3; ++axis) {
          twist[axis] = registration_.locked[static_cast<std::size_t>(axis)] ? 0.0 : twist[axis];
        }
        tried_.push_back(tryMotionAndNear(twist, rough));
      }
    }
    return bestOfTried();
  }

  [[nodiscard]] const Candidate& bestOfTried() const
  {
    std::vector<RegistrationReport> reports;
    for (const Candidate& candidate : tried_) {
      reports.push_back(candidate.report);
    }
    constexpr double kClearlyBetter = 0.9;
    return tried_[bestFit(reports, kClearlyBetter)];
  }

  /// Of the motions that were tried, those quite different from what was found that link and fit features not much
  /// worse than it did at first. The limits are wide: the scans that follow will tell (StartHypotheses).
  [[nodiscard]] std::vector<Vector6> othersThan(const Vector6& found, const Candidate& found_at_first) const
  {
    constexpr double kMostLinked = 0.45;   // of the features; with more the start is plain
    constexpr double kFewestLinked = 0.4;  // of those linked by what was found
    constexpr double kResiduals = 3.0;     // of its residuals
    constexpr std::size_t kMost = 8;
    std::vector<Vector6> others;
    const double linked = found_at_first.correspondences();
    if (linked > kMostLinked * static_cast<double>(registered())) {
      return others;
    }
    std::vector<Candidate> by_fit = tried_;
    std::stable_sort(by_fit.begin(), by_fit.end(), [](const Candidate& a, const Candidate& b) {
      return a.report.residual_rms < b.report.residual_rms;
    });
    for (const Candidate& c : by_fit) {
      const auto isNear = [&c](const Vector6& twist) { return !areApart(twist, c.twist); };
      if (others.size() < kMost && c.report.hasConverged() && c.correspondences() > kFewestLinked * linked &&
          c.report.residual_rms < kResiduals * found_at_first.report.residual_rms && !isNear(found) &&
          std::none_of(others.begin(), others.end(), isNear)) {
        others.push_back(c.twist);
      }
    }
    return others;
  }

  /// How many features of the sample are registered (RegistrationParameters::max_features).
  [[nodiscard]] std::size_t registered() const
  {
    const auto most = static_cast<std::size_t>(registration_.max_features);
    return std::min(sample_.planes.size(), most) + std::min(sample_.edges.size(), most / 6);
  }

  /// Tries a motion, and what was found from it if that is near.
  Candidate tryMotionAndNear(const Vector6& twist, const RegistrationParameters& rough)
  {
    constexpr int kMaxRounds = 3;
    constexpr double kNear = 1.0;   // m: the search radius
    constexpr double kSame = 0.01;  // m
    Vector6 tried = twist;
    Candidate candidate = tryMotion(sample_, tried, 0.0, rough);
    for (int round = 0; round < kMaxRounds && candidate.report.hasConverged(); ++round) {
      const double off = (candidate.twist - tried).head<3>().norm();
      if (off < kSame || off > kNear) {
        break;
      }
      tried = candidate.twist;
      const Candidate next = tryMotion(sample_, tried, 0.0, rough);
      if (!next.report.hasConverged()) {
        break;
      }
      candidate = next;
    }
    return candidate;
  }

  /// Compensates both scans with a motion, and registers them near it.
  Candidate tryMotion(const FeatureSet& second, const Vector6& twist, double uncertainty,
                      const RegistrationParameters& registration, Features features = Features::spread)
  {
    const Vector6 sweep_twist = scans_.sweep_fraction * twist;
    FeatureSet compensated;
    compensate(scans_.first, SweepMotion(sweep_twist, scans_.reference), compensated);
    map_.clear();
    map_.insert(compensated, SE3());
    RegistrationRun run;
    run.guess = exp(scans_.periods * twist);
    run.guess_uncertainty = uncertainty;
    run.threads = parameters_.threads;
    run.spread_features = features == Features::spread;
    run.sparse_target = true;
    run.sweep.twist = sweep_twist;
    run.sweep.reference = scans_.reference;
    const FeatureTarget target{&map_.search(FeatureKind::edge), &map_.search(FeatureKind::plane)};
    Candidate candidate;
    candidate.report = registerFeatures(second, target, run, registration);
    candidate.twist = log(candidate.report.target_T_source) / scans_.periods;
    return candidate;
  }

  const FirstScans& scans_;
  const OdometryParameters& parameters_;
  RegistrationParameters registration_;
  KeyframeVoxelMap map_;
  FeatureSet sample_;
  std::vector<Candidate> tried_;  ///< rest, then fast motions
};

}  // namespace

std::optional<FirstMotion> findFirstMotion(const FirstScans& scans, const OdometryParameters& parameters,
                                           RegistrationReport& report)
{
  return FirstMotionSearch(scans, parameters).run(report);
}

}  // namespace pcl_floam
