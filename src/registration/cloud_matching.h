/// \file cloud_matching.h
/// One resolution of a cloud registration: matches, weights, and the step that follows.
#pragma once

#include "registration/cloud_pyramid.h"
#include "registration/normal_equations.h"
#include "registration/residual_rows.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/cloud_registration.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam {

/// Matches of surfaces may be this many spacings apart, and farther while most of them are.
inline constexpr double kGateSpacings = 3.0;

/// Aligns one level of a source with one of a target. Poses are between the pyramids' origins.
class CloudMatching {
public:
  /// \param along how much a direction along a surface counts against the one across it. 1 draws points to points, all
  ///              of them; with less, far matches are left out and large residuals count less
  /// \param width  m; how far off the pose may be: the kernel takes no smaller residual for an outlier
  CloudMatching(const CloudLevel& source, const CloudLevel& target, const CloudRegistrationRun& run, bool finest,
                double along, double width = 0.0);

  /// Finds the matches at a pose and sums up what they say of a perturbation on the left that turns about the source's
  /// centroid. A match's weight is that of its three dimensions.
  /// \param target_T_source the same pose between the clouds' frames
  NormalEquations evaluate(const SE3& pose, const SE3& target_T_source);

  /// Part of the source's points that lie on the target's surfaces at a pose, less that of those that lie near these
  /// but beside them, or across. What goes on where these end, or is far from any, speaks neither for a pose nor
  /// against it.
  [[nodiscard]] double agreementAt(const SE3& pose) const;

  [[nodiscard]] const std::vector<PointMatch>& matches() const { return matches_; }
  [[nodiscard]] double spacing() const { return spacing_; }

private:
  /// What a match says: the difference of its points, and how much each direction of it counts.
  struct Residual {
    Eigen::Vector3f difference;
    Eigen::Matrix3f m;
    float squared;  ///< difference^T M difference, m^2; negative without a match
  };

  /// What the last search for a source point's nearest target point came to. While the point moves little, it tells the
  /// outcome of the next one, and else bounds it.
  struct LastSearch {
    Eigen::Vector3f place = Eigen::Vector3f::Zero();  ///< where the source point was
    float clear = 0.0F;                               ///< m; no other target point was nearer than this
    int nearest = -1;                                 ///< the last one found
    bool found = false;                               ///< by that search
  };

  void askUsersSearch(const SE3& pose, const SE3& target_T_source);
  void searchNearest(const SE3& pose);
  void searchNearest(std::size_t i, const Eigen::Vector3f& query, float bound);
  void keepReciprocal(const SE3& pose);
  void narrow();
  [[nodiscard]] bool isRobust() const { return along_ < 1.0; }
  [[nodiscard]] bool coincide() const;
  void listMatches();
  void keepListed();
  void weigh(const SE3& pose);
  [[nodiscard]] Residual residual(const SE3& pose, std::size_t i, std::size_t j) const;
  [[nodiscard]] int vote(const SE3& pose, std::size_t i, std::size_t j, float squared_distance) const;
  [[nodiscard]] NormalEquations sum(const SE3& pose) const;
  void accumulate(const SE3& pose, std::size_t i, ResidualRows& rows, NormalEquations& sums) const;

  const CloudLevel& source_;
  const CloudLevel& target_;
  const CloudRegistrationRun& run_;
  bool finest_;
  double along_;
  double spacing_;
  double gate_;  ///< m; pairs farther apart are no matches
  double width_;
  double scale_ = 0.0;                     ///< of the robust kernel, m
  std::vector<LastSearch> last_searches_;  ///< per source point
  std::vector<int> match_;                 ///< per source point, the target point, or -1
  std::vector<float> squared_distance_;    ///< of the match
  std::vector<PointMatch> matches_;
  std::vector<Residual> residuals_;
};

}  // namespace pcl_floam
