#include "world.h"

#include <algorithm>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

struct Entry {
  const char* name;
  World (*make)(const WorldOptions&);
};

constexpr Entry kWorlds[] = {{"warehouse", makeWarehouse}, {"room", makeRoom},          {"urban", makeUrban},
                             {"highway", makeHighway},     {"corridor", makeCorridor},  {"tunnel", makeTunnel},
                             {"handheld", makeHandheld},   {"open-road", makeOpenRoad}, {"town", makeTown},
                             {"motorway", makeMotorway},   {"car-park", makeCarPark},   {"yard", makeYard}};

}  // namespace

World makeWorld(std::string_view name, const WorldOptions& options)
{
  for (const Entry& entry : kWorlds) {
    if (name == entry.name) {
      World world = entry.make(options);
      removeCollisions(world);
      return world;
    }
  }
  throw std::invalid_argument("unknown world '" + std::string(name) + "'");
}

const std::vector<std::string>& worldNames()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Entry& entry : kWorlds) {
      list.emplace_back(entry.name);
    }
    return list;
  }();
  return names;
}

Random randomOfWorld(const WorldOptions& options, std::uint64_t purpose)
{
  return randomOf(options.family, options.seed, purpose);
}

Random randomOfPath(const WorldOptions& options, const Random& world)
{
  constexpr std::uint64_t kPathPurpose = 100;
  return options.path == 1 ? world : randomOfWorld(options, kPathPurpose + static_cast<std::uint64_t>(options.path));
}

void removeCollisions(World& world)
{
  constexpr double kStep = 0.1;  // s
  const auto collides = [&world](const MovingObject& object) {
    for (double t = 0.0; t <= world.sensor_motion.duration(); t += kStep) {
      const Eigen::Vector3d apart = world.sensor_motion.state(t).head<3>() - object.motion.state(t).head<3>();
      if (apart.head<2>().norm() < object.clearance) {
        return true;
      }
    }
    return false;
  };
  world.moving.erase(std::remove_if(world.moving.begin(), world.moving.end(), collides), world.moving.end());
}

}  // namespace pcl_floam::simulator
