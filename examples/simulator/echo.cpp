#include "echo.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kPulse = 1.5;            // m, what 10 ns of light cover there and back
constexpr double kPaneReflection = 0.08;  // of light that meets a pane head-on: 4 % at each of its two faces
constexpr float kDrop = 0.3F;             // reflectivity of drops, flakes and dust as seen
constexpr float kOff = 1e-3F;             // m in front of a mirror that its image is looked for from

RayHit cast(const RayScene& scene, const Pulse& pulse, const Eigen::Vector3d& beam, double reach)
{
  return scene.cast(pulse.world_T_sensor.translation.cast<float>(),
                    (pulse.world_T_sensor.rotation * beam).cast<float>(), static_cast<float>(reach),
                    static_cast<float>(pulse.fraction));
}

/// Part of the light that a pane mirrors, by Schlick's approximation.
double paneReflection(double cosine)
{
  return kPaneReflection + (1.0 - kPaneReflection) * std::pow(1.0 - cosine, 5.0);
}

}  // namespace

/// A wide beam that meets an edge lights two surfaces at once: if they are less than a pulse apart, their echoes melt
/// into one between them. On one slanting surface the two halves of the footprint make up for each other.
RayHit EchoModel::footprint(const RayScene& scene, const Pulse& pulse, Random& random) const
{
  RayHit hit = cast(scene, pulse, pulse.beam, lidar_.max_range);
  if (errors_.beam_divergence <= 0.0) {
    return hit;
  }
  const double angle = random.uniform(0.0, 2.0 * M_PI);
  const double share = random.uniform();
  const Eigen::Vector3d side = pulse.beam.unitOrthogonal();
  const Eigen::Vector3d off = std::cos(angle) * side + std::sin(angle) * pulse.beam.cross(side);
  double sum = 0.0;
  int count = 0;
  for (const double half : {-0.5, 0.5}) {
    const Eigen::Vector3d beam = (pulse.beam + half * errors_.beam_divergence * off).normalized();
    const RayHit other = cast(scene, pulse, beam, lidar_.max_range);
    const double between = static_cast<double>(other.distance) - static_cast<double>(hit.distance);
    if (hit.exists() && other.exists() && std::abs(between) < kPulse) {
      sum += between;
      ++count;
    }
  }
  hit.distance += count > 0 ? static_cast<float>(share * sum / count) : 0.0F;
  return hit;
}

/// \param share of the light that the surface sends back diffusely
bool EchoModel::detects(RayHit& hit, double share, Random& random) const
{
  if (!weather_.isClear()) {
    share *= weather_.transmission(static_cast<double>(hit.distance));
  }
  hit.reflectivity *= static_cast<float>(share);
  return lidar_.detects(hit, random);
}

std::optional<RayHit> EchoModel::mirrorImage(const RayScene& scene, const Pulse& pulse, const RayHit& mirror,
                                             Random& random) const
{
  const Eigen::Vector3f in = (pulse.world_T_sensor.rotation * pulse.beam).cast<float>();
  const Eigen::Vector3f out = in - 2.0F * in.dot(mirror.normal) * mirror.normal;
  const Eigen::Vector3f place = pulse.world_T_sensor.translation.cast<float>() + (mirror.distance - kOff) * in;
  RayHit image = scene.cast(place, out.normalized(), static_cast<float>(lidar_.max_range) - mirror.distance,
                            static_cast<float>(pulse.fraction));
  if (!image.exists()) {
    return std::nullopt;
  }
  image.distance += mirror.distance;
  const double reflection = static_cast<double>(mirror.gloss) * paneReflection(mirror.incidence_cosine);
  return detects(image, reflection * reflection, random) ? std::optional<RayHit>(image) : std::nullopt;
}

std::optional<Echo> EchoModel::echo(const RayScene& scene, const Pulse& pulse, Random& random) const
{
  RayHit hit = footprint(scene, pulse, random);
  if (!weather_.isClear()) {
    const auto range = static_cast<float>(weather_.drawReturn(random));
    if (range<hit.distance&& static_cast<double>(range)> lidar_.min_range &&
        static_cast<double>(range) < lidar_.max_range) {
      return Echo{{range, 1.0F, kDrop, 0.0F, Eigen::Vector3f::Zero(), false}, true};
    }
  }
  if (!hit.exists()) {
    return std::nullopt;
  }
  const RayHit mirror = hit;
  const double gloss = errors_.glass * static_cast<double>(hit.gloss);
  if (detects(hit, 1.0 - gloss, random)) {
    return Echo{hit, false};
  }
  if (gloss > 0.0) {
    if (const auto image = mirrorImage(scene, pulse, mirror, random)) {
      return Echo{*image, true};
    }
  }
  return std::nullopt;
}

}  // namespace pcl_floam::simulator
