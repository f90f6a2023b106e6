/// \file sweep_trajectory.h
/// Where the points of a moving sweep lie: the motion model of compensation and registration.
#pragma once

#include <pcl_floam/common/se3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The sensor's poses during one sweep: T(s) = T(r) exp((s - r) xi + (s - r)^2 alpha / 2); without alpha Eq. 3 and 4
/// (the paper's (N - n)/N moves the wrong end of the sweep; without alpha, whatever sways is off by a part of each
/// swing). Of all instants the middle is the one whose pose depends least on the motion.
///
/// A perturbation of the pose at r, on the left (Eq. 11), moves all points as it would move a rigid scan.
class SweepTrajectory {
public:
  static constexpr double kMiddle = 0.5;

  /// Points side by side, and their times since the reference instant.
  struct Batch {
    static constexpr std::size_t kMost = 32;
    std::array<double, kMost> since, x, y, z;
  };

  /// \param twist        xi, motion over the sweep
  /// \param reference    r in [0, 1], the instant of the pose
  /// \param acceleration alpha, change of the twist over the sweep
  explicit SweepTrajectory(const SE3& target_T_sensor, const Vector6& twist = Vector6::Zero(),
                           double reference = kMiddle, const Vector6& acceleration = Vector6::Zero());

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] const Vector6& twist() const { return twist_; }

  /// Time from the reference instant, in sweeps.
  [[nodiscard]] double sinceReference(double time) const { return time - reference_; }

  /// The places of \p count points, each \p stride after the one before, in the sensor's frame of the reference
  /// instant.
  /// \tparam Point has x, y, z in the sensor's frame and the time as a fraction of the sweep; out of [0, 1] it is taken
  ///               for the nearer end
  /// \param take is called with the number and the place of each
  template <typename Point, typename Take>
  void undistorted(const Point* points, std::size_t stride, std::size_t count, const Take& take) const
  {
    Batch batch{};
    for (std::size_t begin = 0; begin < count; begin += Batch::kMost) {
      const std::size_t n = std::min(Batch::kMost, count - begin);
      for (std::size_t i = 0; i < n; ++i) {
        const Point& point = points[(begin + i) * stride];
        batch.since[i] = sinceReference(std::min(std::max(static_cast<double>(point.time), 0.0), 1.0));
        batch.x[i] = static_cast<double>(point.x);
        batch.y[i] = static_cast<double>(point.y);
        batch.z[i] = static_cast<double>(point.z);
      }
      undistort(batch);
      for (std::size_t i = 0; i < n; ++i) {
        take(begin + i, Eigen::Vector3d(batch.x[i], batch.y[i], batch.z[i]));
      }
    }
  }

  /// The same of all points, by some threads, each of which calls \p take.
  template <typename Point, typename Take>
  void undistorted(const std::vector<Point>& points, int threads, const Take& take) const
  {
    constexpr std::size_t kTogether = 256;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t begin = 0; begin < points.size(); begin += kTogether) {
      undistorted(&points[begin], 1, std::min(kTogether, points.size() - begin),
                  [&](std::size_t i, const Eigen::Vector3d& place) { take(begin + i, place); });
    }
  }

  /// The trajectory perturbed on the left by \p delta at the reference instant.
  [[nodiscard]] SweepTrajectory perturbed(const Vector6& delta) const;

private:
  void undistort(Batch& points) const;

  SE3 pose_;
  Vector6 twist_;
  Vector6 acceleration_;
  double reference_;
  int orders_;  ///< of the exponential's series that tell of the motion
};

}  // namespace pcl_floam
