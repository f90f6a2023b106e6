#include <pcl_floam/filters/core/vertical_angle.h>

#include "common/multi_version.h"
#include "common/pi.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_floam {

namespace {

/// An angle by its sine and cosine.
struct Turn {
  explicit Turn(double degrees) : sine(std::sin(degrees * kRadians)), cosine(std::cos(degrees * kRadians)) {}

  static constexpr double kRadians = kPi / 180.0;
  double sine;
  double cosine;
};

/// In the vertical plane through the point, (horizontal, z) turns by the angle.
inline void turnUp(double sine, double cosine, float& x, float& y, float& z)
{
  const double squared =
      static_cast<double>(x) * static_cast<double>(x) + static_cast<double>(y) * static_cast<double>(y);
  const auto horizontal = static_cast<double>(static_cast<float>(std::sqrt(squared)));
  const auto height = static_cast<double>(z);
  const bool has_azimuth = horizontal > 0.0;
  const double scale = cosine - sine * height / (has_azimuth ? horizontal : 1.0);
  z = has_azimuth ? static_cast<float>(cosine * height + sine * horizontal) : z;
  x = has_azimuth ? static_cast<float>(scale * static_cast<double>(x)) : x;
  y = has_azimuth ? static_cast<float>(scale * static_cast<double>(y)) : y;
}

PCL_FLOAM_MULTI_VERSION
void turnUp(double sine, double cosine, std::size_t count, float* __restrict x, float* __restrict y,
            float* __restrict z)
{
  for (std::size_t n = 0; n < count; ++n) {
    turnUp(sine, cosine, x[n], y[n], z[n]);
  }
}

}  // namespace

void correctVerticalAngle(double degrees, FeatureSet& features)
{
  if (degrees == 0.0) {
    return;
  }
  const Turn turn(degrees);
  for (std::vector<Feature>* kind : {&features.edges, &features.planes}) {
    for (Feature& feature : *kind) {
      turnUp(turn.sine, turn.cosine, feature.x, feature.y, feature.z);
    }
  }
}

void correctVerticalAngle(double degrees, std::size_t count, float* x, float* y, float* z, int threads)
{
  constexpr std::size_t kChunk = 4096;  // points: fewer are turned before a thread has begun
  if (degrees == 0.0) {
    return;
  }
  const Turn turn(degrees);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t first = 0; first < count; first += kChunk) {
    turnUp(turn.sine, turn.cosine, std::min(kChunk, count - first), x + first, y + first, z + first);
  }
}

}  // namespace pcl_floam
