// The page of settings names all that there are, with the defaults that they have.
#include <pcl_floam/odometry/core/odometry_parameters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace pcl_floam::test {
namespace {

template <typename T>
std::string text(const T& value)
{
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::map<std::string, std::string> defaults()
{
  const OdometryParameters p;
  return {{"engine", toString(p.engine)},
          {"compensation", toString(p.compensation)},
          {"timing_source", toString(p.timing_source)},
          {"sensor", "auto"},
          {"scan_period", text(p.scan_period)},
          {"vertical_correction", text(p.vertical_correction)},
          {"pose_instant", toString(p.pose_instant)},
          {"features.edges_per_sector", text(p.features.edges_per_sector)},
          {"features.planes_per_sector", text(p.features.planes_per_sector)},
          {"features.min_range", text(p.features.min_range)},
          {"features.max_range", text(p.features.max_range)},
          {"features.smoothness", toString(p.features.smoothness)},
          {"features.edge_threshold", text(p.features.edge_threshold)},
          {"features.plane_threshold", text(p.features.plane_threshold)},
          {"registration.weights", toString(p.registration.weights)},
          {"registration.kernel", toString(p.registration.kernel)},
          {"registration.locked", "none"},
          {"registration.solver", toString(p.registration.solver)},
          {"map.voxel_size", text(p.map.voxel_size)},
          {"map.horizon", text(p.map.horizon)},
          {"map.see_through_range", text(p.map.see_through_range)},
          {"keyframe.translation", text(p.keyframe.translation)},
          {"map.search", toString(p.map.search)},
          {"start_effort", text(p.start_effort)},
          {"threads", text(p.threads)}};
}

TEST(TuningPage, HasEverySettingWithItsDefault)
{
  std::ifstream page(PCL_FLOAM_TUNING_PAGE);
  ASSERT_TRUE(page);
  const std::regex row("[|] `([a-z_.]+)` [|] `?([^ `|,]+).*");
  auto expected = defaults();
  for (auto& setting : expected) {  // as C++ has it
    std::replace(setting.second.begin(), setting.second.end(), '-', '_');
  }
  std::set<std::string> seen;
  for (std::string line; std::getline(page, line) && line.rfind("## Registering two clouds", 0) != 0;) {
    std::smatch parts;
    if (std::regex_match(line, parts, row)) {
      ASSERT_EQ(expected.count(parts[1]), 1U) << parts[1];
      EXPECT_EQ(parts[2], expected.at(parts[1])) << parts[1];
      EXPECT_TRUE(seen.insert(parts[1]).second) << parts[1];
    }
  }
  EXPECT_EQ(seen.size(), expected.size());
}

}  // namespace
}  // namespace pcl_floam::test
