// Scan lines that the cloud's fields and layout tell: ring field, organised rows.
#include "common/azimuth.h"
#include "common/field_type.h"
#include "common/sort_key.h"
#include "filters/line_grouping.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Fewer lines than this are no rotating lidar's.
constexpr int kMinScanLines = 2;

/// Steps between neighbours of a line that go the prevailing way, in a cloud that keeps a sweep's order.
/// Neighbours swap places where lasers' azimuths differ and where the range noise exceeds the spacing.
constexpr float kSweepOrderConfidence = 0.8F;

/// Mean |elevation step| (as a tangent) along a direction of an organised cloud.
float meanElevationStep(const CloudView& cloud, std::size_t step, std::size_t line_length, std::size_t line_step)
{
  double sum = 0.0;
  std::size_t count = 0;
  const std::size_t lines = cloud.size / line_length;
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::size_t n = 0; n + 1 < line_length; n += 7) {  // a sample of the neighbours tells as much as all
      const std::size_t a = line * line_step + n * step;
      const std::size_t b = a + step;
      if (isMeasurable(cloud, a) && isMeasurable(cloud, b)) {
        sum +=
            std::abs(cloud.z(a) / std::hypot(cloud.x(a), cloud.y(a)) - cloud.z(b) / std::hypot(cloud.x(b), cloud.y(b)));
        ++count;
      }
    }
  }
  return count == 0 ? 0.0F : static_cast<float>(sum / static_cast<double>(count));
}

/// Points of the same azimuth stay in the order of their numbers.
void sortByAzimuth(const CloudView& cloud, std::int32_t* points, std::size_t count)
{
  std::vector<std::uint64_t> keys(count);  // azimuth, whose bits rise with it, since it is not negative; and number
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(points[n]);
    const float azimuth = pseudoAzimuth(cloud.x(i), cloud.y(i)) + 0.0F;  // no negative zero
    keys[n] = sortKey(azimuth, static_cast<std::uint32_t>(i));
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t n = 0; n < count; ++n) {
    points[n] = static_cast<std::int32_t>(keys[n] & 0xFFFFFFFFU);
  }
}

}  // namespace

void ensureSweepOrder(const CloudView& cloud, ScanLines& lines, int threads)
{
  constexpr std::int32_t kSampled = 5;  // one step in so many tells as much as all; odd, since drivers' habits are even
  const std::size_t line_count = lines.lines();
  std::size_t rising = 0;
  std::size_t falling = 0;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(+ : rising, falling)
  for (std::size_t m = 0; m < line_count; ++m) {
    for (std::int32_t n = lines.begin[m] + 1; n < lines.begin[m + 1]; n += kSampled) {
      const auto a = static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n) - 1]);
      const auto b = static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n)]);
      const float turn = cloud.x(a) * cloud.y(b) - cloud.y(a) * cloud.x(b);  // of a left turn's sign
      rising += turn > 0.0F ? 1U : 0U;
      falling += turn < 0.0F ? 1U : 0U;
    }
  }
  const std::size_t steps = rising + falling;
  lines.confidence = steps == 0 ? 0.0F : static_cast<float>(std::max(rising, falling)) / static_cast<float>(steps);
  if (lines.confidence >= kSweepOrderConfidence) {
    return;
  }
  lines.sorted_by_azimuth = true;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t m = 0; m < line_count; ++m) {
    sortByAzimuth(cloud, lines.index.data() + lines.begin[m],
                  static_cast<std::size_t>(lines.begin[m + 1] - lines.begin[m]));
  }
}

bool linesFromRingField(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, LineGrouping& grouping,
                        ScanLines& lines)
{
  if (!cloud.ring.exists()) {
    return false;
  }
  withReader(cloud.ring, [&](const auto& ring_of) {
    grouping.assign(cloud, threads, [cloud, ring_of](std::size_t i) {
      const double ring = ring_of(cloud.point(i));
      const bool is_line = ring >= 0.0 && ring < kMaxScanLines && ring == static_cast<std::int32_t>(ring);
      return is_line ? static_cast<int>(ring) : LineGrouping::kNoLine;
    });
  });
  // A ring field that the driver left at zero, or that holds something else, is no ring field.
  if (grouping.used() < kMinScanLines || grouping.onLines() * 2 < grouping.measurable()) {
    return false;
  }
  grouping.list(grouping.end(), lines);
  ensureSweepOrder(cloud, lines, threads);
  return true;
}

bool linesFromOrganizedRows(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, LineGrouping& grouping,
                            ScanLines& lines)
{
  if (cloud.height < kMinScanLines || cloud.width < kMinScanLines ||
      static_cast<std::size_t>(cloud.width) * cloud.height != cloud.size) {
    return false;
  }
  // A scan line keeps its elevation; the other direction of the grid does not.
  lines.transposed =
      meanElevationStep(cloud, 1, cloud.width, cloud.width) > meanElevationStep(cloud, cloud.width, cloud.height, 1);
  const std::uint32_t line_count = lines.transposed ? cloud.width : cloud.height;
  if (line_count > kMaxScanLines) {
    return false;
  }
  grouping.assign(cloud, threads, [&](std::size_t i) {
    return static_cast<int>(lines.transposed ? i % cloud.width : i / cloud.width);
  });
  grouping.list(static_cast<int>(line_count), lines);
  ensureSweepOrder(cloud, lines, threads);
  // Depth images are organised too, but their rows do not run around the sensor in one direction unless seen so;
  // either way neighbours in a row are neighbours on the surface, which is all that is needed.
  return true;
}

}  // namespace pcl_floam
