#include "echo.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kPulse = 1.5;            // m, what 10 ns of light cover there and back
constexpr double kPaneReflection = 0.08;  // of light that meets a pane head-on: 4 % at each of its two faces
constexpr float kDrop = 0.3F;             // reflectivity of drops, flakes and dust as seen
constexpr float kOff = 1e-3F;             // m from a pane that the light is followed from
constexpr float kPaint = 0.9F;            // gloss up to which a surface is paint, which lets nothing through

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

/// As of a drop.
Echo falseEcho(double range)
{
  return {{static_cast<float>(range), 1.0F, kDrop, 0.0F, Eigen::Vector3f::Zero(), false}, true};
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
  for (const double half : {-0.5, 0.5}) {
    const Eigen::Vector3d beam = (pulse.beam + half * errors_.beam_divergence * off).normalized();
    const RayHit other = cast(scene, pulse, beam, lidar_.max_range);
    const double between = static_cast<double>(other.distance) - static_cast<double>(hit.distance);
    if (hit.exists() && other.exists() && std::abs(between) < kPulse) {
      sum += between;
    }
  }
  // The middle of the beam has at least half of its light.
  hit.distance += static_cast<float>(0.25 * share * sum);
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

std::optional<RayHit> EchoModel::follow(const RayScene& scene, const Pulse& pulse, const Surface& surface,
                                        const Eigen::Vector3f& direction, double share, Random& random) const
{
  const auto reach = static_cast<float>(lidar_.max_range) - surface.distance - kOff;
  RayHit hit = scene.cast(surface.place + kOff * direction, direction, reach, static_cast<float>(pulse.fraction));
  if (!hit.exists()) {
    return std::nullopt;
  }
  hit.distance += surface.distance + kOff;
  // The light passes the surface on its way there and back.
  return detects(hit, share * share * (1.0 - static_cast<double>(hit.gloss)), random) ? std::optional<RayHit>(hit)
                                                                                      : std::nullopt;
}

std::optional<Echo> EchoModel::echoByGloss(const RayScene& scene, const Pulse& pulse, const RayHit& hit,
                                           Random& random) const
{
  const Eigen::Vector3f in = (pulse.world_T_sensor.rotation * pulse.beam).cast<float>();
  const Surface surface{pulse.world_T_sensor.translation.cast<float>() + hit.distance * in, hit.distance};
  const double gloss = errors_.glass * static_cast<double>(hit.gloss);
  const double mirrored = paneReflection(static_cast<double>(hit.incidence_cosine));
  if (hit.gloss > kPaint) {
    if (const auto behind = follow(scene, pulse, surface, in, gloss * (1.0 - mirrored), random)) {
      return Echo{*behind, false};
    }
  }
  const Eigen::Vector3f out = (in - 2.0F * in.dot(hit.normal) * hit.normal).normalized();
  if (const auto image = follow(scene, pulse, surface, out, gloss * mirrored, random)) {
    return Echo{*image, true};
  }
  return std::nullopt;
}

std::optional<Echo> EchoModel::echo(const RayScene& scene, const Pulse& pulse, Random& random) const
{
  if (weather_.stray > 0.0 && random.chance(weather_.stray)) {
    return falseEcho(random.uniform(lidar_.min_range, lidar_.max_range));
  }
  RayHit hit = footprint(scene, pulse, random);
  if (!weather_.isClear()) {
    const auto range = static_cast<float>(weather_.drawReturn(random));
    if (range<hit.distance&& static_cast<double>(range)> lidar_.min_range &&
        static_cast<double>(range) < lidar_.max_range) {
      return falseEcho(static_cast<double>(range));
    }
  }
  if (!hit.exists()) {
    return std::nullopt;
  }
  const RayHit glossy = hit;
  const double gloss = errors_.glass * static_cast<double>(hit.gloss);
  if (detects(hit, 1.0 - gloss, random)) {
    return Echo{hit, false};
  }
  return gloss > 0.0 ? echoByGloss(scene, pulse, glossy, random) : std::nullopt;
}

}  // namespace pcl_floam::simulator
