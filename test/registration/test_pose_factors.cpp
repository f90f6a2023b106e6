// A user's factors as a registration takes them: in its target's axes, about a point of its own.
#include "registration/pose_factors.h"

#include <gtest/gtest.h>

#include <memory>

namespace pcl_floam {
namespace {

/// A place that is seen from the source, and known in the world.
class KnownPlace : public PoseFactor {
public:
  [[nodiscard]] static Eigen::Vector3d residualAt(const SE3& world_T_source)
  {
    return world_T_source * Eigen::Vector3d(3.0, 1.0, -2.0) - Eigen::Vector3d(1.0, 2.0, 3.0);
  }

  void addTo(const SE3& world_T_source, PoseEquations& equations) const override
  {
    const Eigen::Vector3d from_origin = world_T_source.rotation * Eigen::Vector3d(3.0, 1.0, -2.0);
    const Eigen::Vector3d residual = residualAt(world_T_source);
    for (int i = 0; i < 3; ++i) {
      Vector6 derivative;
      derivative << Eigen::Vector3d::Unit(i), from_origin.cross(Eigen::Vector3d::Unit(i));
      equations.add(residual[i], derivative, 1.0);
    }
  }
};

/// Moved by a perturbation about a point that is \p arm from the source's origin.
SE3 moved(const SE3& target_T_source, const Eigen::Vector3d& arm, const Vector6& by)
{
  const Eigen::Matrix3d turn = expSO3(by.tail<3>());
  return {turn * target_T_source.rotation, target_T_source.translation + arm + by.head<3>() - turn * arm};
}

TEST(PoseFactors, EquationsAreThoseOfTheNumericDerivative)
{
  constexpr double kStep = 1e-5;
  const SE3 target_T_source = exp((Vector6() << 4.0, -3.0, 2.0, 0.4, -0.3, 1.1).finished());
  const PoseFactors factors{{std::make_shared<KnownPlace>()},
                            exp((Vector6() << 20.0, 10.0, -5.0, -0.7, 0.2, 2.0).finished())};
  for (const Eigen::Vector3d& arm : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(10.0, -7.0, 3.0)}) {
    const auto residual = [&](const Vector6& by) {
      return KnownPlace::residualAt(factors.world_T_target * moved(target_T_source, arm, by));
    };
    Eigen::Matrix<double, 3, 6> derivative;
    for (int i = 0; i < 6; ++i) {
      const Vector6 by = kStep * Vector6::Unit(i);
      derivative.col(i) = (residual(by) - residual(-by)) / (2.0 * kStep);
    }
    const PoseEquations found = factors.at(target_T_source, arm);
    EXPECT_LT((found.information - derivative.transpose() * derivative).norm(), 1e-6);
    EXPECT_LT((found.gradient - derivative.transpose() * residual(Vector6::Zero())).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace pcl_floam
