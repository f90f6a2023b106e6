#include "registration/laser_errors.h"

#include <algorithm>

namespace pcl_floam {

/// Points come laser by laser, so it mostly is the last one.
LaserErrors::Angle& LaserErrors::of(std::uint32_t laser)
{
  if (!angles_.empty() && angles_.back().laser == laser) {
    return angles_.back();
  }
  const auto place = std::lower_bound(angles_.begin(), angles_.end(), laser,
                                      [](const Angle& angle, std::uint32_t l) { return angle.laser < l; });
  if (place != angles_.end() && place->laser == laser) {
    return *place;
  }
  Angle angle;
  angle.laser = laser;
  return *angles_.insert(place, angle);
}

void LaserErrors::add(std::uint32_t laser, double raised, const Eigen::Matrix<double, 6, 1>& jacobian, double residual,
                      double weight, double since_middle)
{
  Angle& angle = of(laser);
  angle.information += weight * raised * raised;
  angle.gradient += weight * raised * residual;
  angle.coupling += weight * raised * jacobian;
  angle.with_twist += weight * raised * since_middle * jacobian;
}

void LaserErrors::add(const LaserErrors& other)
{
  for (const Angle& more : other.angles_) {
    Angle& angle = of(more.laser);
    angle.information += more.information;
    angle.gradient += more.gradient;
    angle.coupling += more.coupling;
    angle.with_twist += more.with_twist;
  }
}

void LaserErrors::takeFrom(NormalEquations& equations, double known) const
{
  for (const Angle& angle : angles_) {
    const Vector6 pose = angle.coupling / (angle.information + known);
    const Vector6 twist = angle.with_twist / (angle.information + known);
    equations.information -= pose * angle.coupling.transpose();
    equations.coupling -= pose * angle.with_twist.transpose();
    equations.twist_information -= twist * angle.with_twist.transpose();
    equations.gradient -= pose * angle.gradient;
    equations.twist_gradient -= twist * angle.gradient;
  }
}

}  // namespace pcl_floam
