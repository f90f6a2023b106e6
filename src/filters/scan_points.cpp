#include <pcl_floam/filters/scan_points.h>

#include "common/field_type.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// In a loop of its own, for which the type of the time field is found out once.
void setTimes(const CloudView& cloud, const ScanTiming& timing, std::vector<ScanPoint>& points)
{
  if (timing.source == ScanTimingSource::time_field) {
    withReader(cloud.time, [&](const auto& time_of) {
      for (ScanPoint& point : points) {
        point.time = timing.fractionOf(time_of(cloud.point(static_cast<std::size_t>(point.index))));
      }
    });
  } else if (timing.valid()) {
    for (ScanPoint& point : points) {
      point.time = timing.at(cloud, static_cast<std::size_t>(point.index));
    }
  }
}

}  // namespace

void collectPoints(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing, double min_range,
                   double max_range, std::vector<ScanPoint>& points)
{
  const auto nearest = static_cast<float>(min_range * min_range);
  const auto farthest = static_cast<float>(max_range * max_range);
  points.resize(lines.valid() ? lines.index.size() : cloud.size);
  std::size_t taken = 0;
  const auto take = [&](std::size_t i, std::uint32_t laser) {
    const float x = cloud.x(i);
    const float y = cloud.y(i);
    const float z = cloud.z(i);
    const float squared = x * x + y * y + z * z;
    points[taken] = {x, y, z, 0.5F, laser, static_cast<std::int32_t>(i)};
    taken += squared >= nearest && squared <= farthest ? 1 : 0;  // refuses NaN, too
  };
  if (lines.valid()) {
    for (std::size_t m = 0; m < lines.lines(); ++m) {
      for (std::int32_t n = lines.begin[m]; n < lines.begin[m + 1]; ++n) {
        take(static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n)]), static_cast<std::uint32_t>(m));
      }
    }
  } else {
    for (std::size_t i = 0; i < cloud.size; ++i) {
      if (isMeasurable(cloud, i)) {
        take(i, static_cast<std::uint32_t>(i));
      }
    }
  }
  points.resize(taken);
  setTimes(cloud, timing, points);
}

/// As large as the last sample asked for; smaller tables stay in the cache.
void SpatialSampling::forget()
{
  constexpr std::size_t kFewest = 1024;
  constexpr unsigned kFewestShift = 64 - 10;
  std::size_t slots = kFewest;
  shift_ = kFewestShift;
  for (; slots < 4 * used_; slots *= 2) {
    --shift_;
  }
  table_.assign(slots, 0);
  used_ = 0;
  last_ = 0;
}

void SpatialSampling::grow()
{
  std::vector<std::uint64_t> old(2 * table_.size(), 0);
  old.swap(table_);
  --shift_;
  for (const std::uint64_t key : old) {
    if (key != 0) {
      table_[placeOf(key)] = key;
    }
  }
}

/// Where a key is, or where it would come.
std::size_t SpatialSampling::placeOf(std::uint64_t key) const
{
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio: spreads all bits upwards
  auto i = static_cast<std::size_t>((key * kGolden) >> shift_);
  while (table_[i] != 0 && table_[i] != key) {
    i = (i + 1) & (table_.size() - 1);
  }
  return i;
}

bool SpatialSampling::isFirst(const ScanPoint& point, float inverse_side)
{
  constexpr float kOffset = 1 << 20;  // makes all coordinates positive, of which the integer part is the floor
  const auto coordinate = [inverse_side](float v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<double>(v * inverse_side) + kOffset)) &
           0x1FFFFFU;
  };
  const std::uint64_t key = (coordinate(point.x) << 42U | coordinate(point.y) << 21U | coordinate(point.z)) + 1;
  if (key == last_) {
    return false;
  }
  last_ = key;
  const std::size_t place = placeOf(key);
  if (table_[place] == key) {
    return false;
  }
  table_[place] = key;
  if (2 * ++used_ > table_.size()) {
    grow();
  }
  return true;
}

void SpatialSampling::sample(const std::vector<ScanPoint>& points, double side, std::vector<ScanPoint>& sample)
{
  sample.clear();
  forget();
  const auto inverse_side = static_cast<float>(1.0 / side);
  for (const ScanPoint& point : points) {
    if (isFirst(point, inverse_side)) {
      sample.push_back(point);
    }
  }
}

double SpatialSampling::sideFor(const std::vector<ScanPoint>& points, std::size_t cells)
{
  constexpr double kSmallest = 1e-3;  // m: finer than any lidar measures
  constexpr double kGreatest = 1e3;   // m: farther than any lidar sees
  constexpr int kHalvings = 16;       // to a part in 5,000
  if (points.empty()) {
    return 0.0;
  }
  double small = std::log(kSmallest);
  double great = std::log(kGreatest);
  std::vector<ScanPoint> taken;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (small + great);
    sample(points, std::exp(middle), taken);
    (taken.size() > cells ? small : great) = middle;
  }
  return std::exp(great);
}

}  // namespace pcl_floam
