#include "odometry/vertical_correction.h"

#include <cmath>

namespace pcl_floam {

namespace {

template <typename Point>
void correct(double degrees, std::vector<Point>& features)
{
  if (degrees == 0.0) {
    return;
  }
  constexpr double kRadians = 3.14159265358979323846 / 180.0;
  const double sine = std::sin(degrees * kRadians);
  const double cosine = std::cos(degrees * kRadians);
  for (Point& f : features) {
    const double horizontal = std::hypot(f.x, f.y);
    if (horizontal > 0.0) {
      // In the vertical plane through the point, (horizontal, z) turns by the angle.
      const double scale = cosine - sine * f.z / horizontal;
      f.z = static_cast<float>(cosine * f.z + sine * horizontal);
      f.x = static_cast<float>(scale * f.x);
      f.y = static_cast<float>(scale * f.y);
    }
  }
}

}  // namespace

void correctVerticalAngle(double degrees, FeatureSet& features)
{
  correct(degrees, features.edges);
  correct(degrees, features.planes);
}

void correctVerticalAngle(double degrees, std::vector<ScanPoint>& points)
{
  correct(degrees, points);
}

}  // namespace pcl_floam
