/// \file rest.h
/// Whether the sensor stands still, and where.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// At rest, poses differ by the noise of their registration alone: a step from one to the next is undone by later ones,
/// and none lies far from the mean, by those steps as by the covariance: what sways or shakes undoes its steps, too. A
/// motion slower than the noise of ten poses looks like rest until it has led out of the noise.
class Rest {
public:
  /// The pose of the next scan, as it was found.
  /// \param covariance of its errors, both as \ref RegistrationReport has them
  void take(const SE3& pose, const Matrix6& covariance);

  [[nodiscard]] bool isAtRest() const { return is_at_rest_; }
  /// Poses taken since the sensor may have come to rest.
  [[nodiscard]] int poses() const { return poses_; }
  /// Their mean.
  [[nodiscard]] const SE3& pose() const { return mean_; }

private:
  static constexpr int kMostPoses = 20;  // if these are no rest, the sensor may have come to it among them

  /// Of one half of a pose, the position or the rotation, by vectors in the world's axes, m or rad.
  class Scatter {
  public:
    [[nodiscard]] bool isFar(const Eigen::Vector3d& from_mean, int poses) const;
    void add(const Eigen::Vector3d& step);
    [[nodiscard]] bool isNoise() const;

  private:
    Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
    double squares_ = 0.0;   // of the steps
    double products_ = 0.0;  // of each step with the one before
  };

  int poses_ = 0;
  bool is_at_rest_ = false;
  SE3 mean_;
  SE3 last_;
  Scatter position_;
  Scatter rotation_;
};

}  // namespace pcl_floam
