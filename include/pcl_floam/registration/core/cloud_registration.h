/// \file cloud_registration.h
/// Registration of clouds of any origin, for every point type: the core of \ref EdgePlaneRegistration for clouds
/// without scan lines.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/pose_factor.h>
#include <pcl_floam/registration/core/registration_parameters.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace pcl_floam {

class CloudPyramid;

/// A cloud made ready for registration: points about their centroid, a search tree, the shape around each point, and
/// thinned versions of all that, made when they are first needed. Where a scanner's points lie so much closer along its
/// scan lines than across them that neighbourhoods show these and no surfaces, the means of its points within voxels
/// stand for them from the beginning. It does not depend on what it was registered with, and may be registered in
/// several threads at a time.
class PreparedCloud {
public:
  /// \param selectable one flag per point; empty: all take part. Points that are not finite never do, nor do points at
  ///                   exactly (0, 0, 0) if there are several: they stand for "no return". Others that are the same
  ///                   are one.
  PreparedCloud(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads);
  /// Only what \ref alignRoughly needs: a few thousand points.
  [[nodiscard]] static PreparedCloud thinned(const CloudView& cloud, const std::vector<std::uint8_t>& selectable,
                                             int threads);
  ~PreparedCloud();
  PreparedCloud(PreparedCloud&& other) noexcept;
  PreparedCloud& operator=(PreparedCloud&& other) noexcept;

  [[nodiscard]] bool empty() const;

  [[nodiscard]] const CloudPyramid& pyramid() const { return *pyramid_; }

private:
  explicit PreparedCloud(std::unique_ptr<CloudPyramid> pyramid);

  std::unique_ptr<CloudPyramid> pyramid_;
};

/// Two points taken for the same place, by their numbers in the clouds.
struct PointMatch {
  int source = 0;
  int target = 0;
  float squared_distance = 0.0F;  ///< m^2
};

/// What one iteration on the full clouds did.
struct CloudIteration {
  SE3 step;                                          ///< applied on the left of the previous estimate
  SE3 target_T_source;                               ///< the estimate, including the step
  const std::vector<PointMatch>* matches = nullptr;  ///< those that were used; only if `wants_matches`
};

/// Settings of one registration.
struct CloudRegistrationRun {
  SE3 guess;  ///< target_T_source
  int threads = 1;
  /// On the full clouds, >= 1. Thinned clouds are registered first, unless so few iterations are asked for that it is
  /// them that matter (below 4).
  int max_iterations = 30;
  bool coarse_first = true;                                       ///< false: the guess is known to be close
  double max_distance = std::numeric_limits<double>::infinity();  ///< m; matches are no farther apart
  double epsilon = 0.0;  ///< m; go on until points move less than this, if that is finer than the default; 0: default
  int min_correspondences = 3;
  bool reciprocal = false;  ///< only matches that are each other's nearest
  RobustKernel kernel = RobustKernel::cauchy;
  std::vector<PoseFactor::ConstPtr> factors;  ///< what else is known of the pose
  DegreesOfFreedom locked = {};  ///< these keep the guess's value: translations exactly, see RegistrationParameters
  bool wants_matches = false;
  /// Takes away from the matches of each iteration what it does not want; source points are at \p target_T_source.
  std::function<void(const SE3& target_T_source, std::vector<PointMatch>& matches)> reject;
  /// Called after each iteration; true ends the registration, which has then converged.
  std::function<bool(const CloudIteration&)> iterated;
  /// A search to use in place of the target's own on the full cloud: for each of the source's points named, moved by
  /// \p target_T_source, the number of the target's point that belongs to it, or -1.
  std::function<std::vector<int>(const std::vector<int>& source, const SE3& target_T_source)> search;
};

/// Registers two clouds: nearest points, each pair weighed by the shapes around both (line, plane or point), with a
/// robust kernel and a search distance that adapt, first between thinned clouds.
///
/// All lengths are relative to the clouds' spacing. Never throws for data; the report tells what came of it.
/// Bit-identical for every number of threads.
[[nodiscard]] RegistrationReport registerClouds(const PreparedCloud& source, const PreparedCloud& target,
                                                const CloudRegistrationRun& run);

/// Where a registration by other means should start: at what registering thinned clouds comes to, or at the guess if
/// the clouds agree better there. Takes a few milliseconds.
[[nodiscard]] SE3 alignRoughly(const PreparedCloud& source, const PreparedCloud& target,
                               const CloudRegistrationRun& run);

}  // namespace pcl_floam
