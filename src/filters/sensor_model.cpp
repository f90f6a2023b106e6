#include <pcl_floam/filters/core/sensor_model.h>

#include "common/pi.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace pcl_floam {

namespace {

constexpr float kRadPerDegree = static_cast<float>(kPi / 180.0);
constexpr const char* kSolidState = "solid-state";

/// \p count elevations in degrees, evenly from \p lowest to \p highest.
std::vector<float> evenly(int count, float lowest, float highest)
{
  std::vector<float> degrees(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    degrees[static_cast<std::size_t>(i)] =
        lowest + (highest - lowest) * static_cast<float>(i) / static_cast<float>(count - 1);
  }
  return degrees;
}

/// HDL-64E: an upper block of 32 lasers 1/3 degree apart and a lower one 1/2 degree apart.
std::vector<float> hdl64()
{
  std::vector<float> degrees = evenly(32, -8.83F - 15.5F, -8.83F);
  const std::vector<float> upper = evenly(32, 2.0F - 31.0F / 3.0F, 2.0F);
  degrees.insert(degrees.end(), upper.begin(), upper.end());
  return degrees;
}

std::vector<float> vlp32c()
{
  return {-25.0F, -15.639F, -11.31F, -8.843F, -7.254F, -6.148F, -5.333F, -4.667F, -4.0F,   -3.667F, -3.333F,
          -3.0F,  -2.667F,  -2.333F, -2.0F,   -1.667F, -1.333F, -1.0F,   -0.667F, -0.333F, 0.0F,    0.333F,
          0.667F, 1.0F,     1.333F,  1.667F,  2.333F,  3.333F,  4.667F,  7.0F,    10.333F, 15.0F};
}

/// Names, and elevations in degrees; none where they are not known.
using Table = std::vector<std::pair<std::string, std::vector<float>>>;

Table sensorTable()
{
  Table table{{"auto", {}},
              {kSolidState, {}},
              {"vlp16", evenly(16, -15.0F, 15.0F)},
              {"vlp32c", vlp32c()},
              {"hdl32", evenly(32, -30.67F, 10.67F)},
              {"hdl64", hdl64()}};
  const std::vector<std::pair<std::string, float>> ousters{
      {"os", 22.5F}, {"os0-", 45.0F}, {"os1-", 22.5F}, {"os2-", 11.25F}};
  for (const auto& [prefix, half_view] : ousters) {
    for (const int beams : {32, 64, 128}) {
      table.emplace_back(prefix + std::to_string(beams), evenly(beams, -half_view, half_view));
    }
  }
  table.emplace_back("pandarxt16", evenly(16, -15.0F, 15.0F));
  table.emplace_back("pandarxt32", evenly(32, -16.0F, 15.0F));
  return table;
}

}  // namespace

SensorModel sensorModel(std::string_view name)
{
  std::string known;
  for (const auto& [entry, degrees] : sensorTable()) {
    if (entry == name) {
      return degrees.empty() ? SensorModel{entry, {}, entry != kSolidState} : customSensor(entry, degrees);
    }
    known += (known.empty() ? "" : ", ") + entry;
  }
  throw std::invalid_argument("unknown sensor '" + std::string(name) + "'; known are: " + known);
}

std::vector<std::string> sensorNames()
{
  std::vector<std::string> names;
  for (const auto& entry : sensorTable()) {
    names.push_back(entry.first);
  }
  return names;
}

SensorModel customSensor(std::string name, const std::vector<float>& elevations_degrees)
{
  if (elevations_degrees.size() < 2 || elevations_degrees.size() > kMaxScanLines) {
    throw std::invalid_argument("sensor '" + name + "' needs 2 to " + std::to_string(kMaxScanLines) + " beams");
  }
  SensorModel model{std::move(name), {}, true};
  for (const float degrees : elevations_degrees) {
    if (!(std::abs(degrees) <= 90.0F)) {
      throw std::invalid_argument("an elevation of sensor '" + model.name + "' is not within [-90, 90] degrees");
    }
    model.elevations.push_back(degrees * kRadPerDegree);
  }
  std::sort(model.elevations.begin(), model.elevations.end());
  return model;
}

}  // namespace pcl_floam
