// Scan lines that the cloud's layout tells: ring field, organised rows, file order.
#include "common/field_type.h"
#include "common/multi_version.h"
#include "filters/azimuth.h"
#include "filters/line_grouping.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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

/// Consecutive measurable points of a cloud, enough to make a loop over them worth while.
struct PointRun {
  static constexpr std::size_t kMost = 256;

  std::size_t count = 0;
  std::size_t place = 0;  ///< number of measurable points before this run's first
  std::array<float, kMost> x;
  std::array<float, kMost> y;
  std::array<float, kMost> azimuth;  ///< pseudo-azimuth
};

PCL_FLOAM_MULTI_VERSION
void computeAzimuths(std::size_t count, const float* x, const float* y, float* azimuth)
{
  for (std::size_t n = 0; n < count; ++n) {
    azimuth[n] = pseudoAzimuth(x[n], y[n]);
  }
}

/// Steps of azimuth that go up, go down, and jump back to where a line begins.
struct StepCounts {
  std::int32_t rising = 0;
  std::int32_t falling = 0;
  std::int32_t jumps = 0;
};

constexpr float kJump = 2.4F;  // 0.6 of a turn: lines may begin late and end early

/// From azimuth 0 at the front to 0 at the rear.
inline float turnedByHalf(float azimuth)
{
  return azimuth + (azimuth < 2.0F ? 2.0F : -2.0F);
}

/// A step as seen with azimuth 0 at the rear instead of at the front.
inline float stepFromRear(float before, float after)
{
  return turnedByHalf(after) - turnedByHalf(before);
}

inline void count(float step, StepCounts& counts)
{
  counts.rising += static_cast<std::int32_t>(step > 0.0F) & static_cast<std::int32_t>(step <= kJump);
  counts.falling += static_cast<std::int32_t>(step < 0.0F) & static_cast<std::int32_t>(step >= -kJump);
  counts.jumps += static_cast<std::int32_t>(std::abs(step) > kJump);
}

PCL_FLOAM_MULTI_VERSION
void countSteps(std::size_t points, const float* azimuth, StepCounts& front, StepCounts& rear)
{
  StepCounts from_front;
  StepCounts from_rear;
  for (std::size_t n = 1; n < points; ++n) {
    count(azimuth[n] - azimuth[n - 1], from_front);
    count(stepFromRear(azimuth[n - 1], azimuth[n]), from_rear);
  }
  front = from_front;
  rear = from_rear;
}

/// The scan lines that result if the cloud's order is cut wherever azimuth jumps back by most of a turn.
struct OrderCut {
  std::vector<std::int32_t> begin;  ///< of the lines but the first
  std::size_t rising = 0;
  std::size_t falling = 0;
  std::size_t jumps_up = 0;
  std::size_t jumps_down = 0;

  /// Adds the steps within a run; the next run begins with this one's last point.
  template <typename StepOf>
  void advance(const PointRun& run, const StepCounts& counts, const StepOf& stepOf)
  {
    rising += static_cast<std::size_t>(counts.rising);
    falling += static_cast<std::size_t>(counts.falling);
    for (std::size_t n = 1; n < run.count && counts.jumps > 0; ++n) {
      const float step = stepOf(run.azimuth[n - 1], run.azimuth[n]);
      if (std::abs(step) > kJump) {
        (step > 0.0F ? jumps_up : jumps_down)++;
        if (begin.size() <= kMaxScanLines) {  // more of them are not plausible, however many
          begin.push_back(static_cast<std::int32_t>(run.place + n));
        }
      }
    }
  }

  /// Adds the steps of the cloud's next part.
  void append(const OrderCut& next)
  {
    begin.insert(begin.end(), next.begin.begin(), next.begin.end());
    rising += next.rising;
    falling += next.falling;
    jumps_up += next.jumps_up;
    jumps_down += next.jumps_down;
  }

  [[nodiscard]] bool rises() const { return rising >= falling; }

  /// Mean change of elevation from one line to the next.
  [[nodiscard]] double meanTilt(const CloudView& cloud, const ScanLines& lines) const
  {
    double tilt = 0.0;
    for (const std::int32_t place : begin) {
      const auto n = static_cast<std::size_t>(place);
      tilt += std::abs(elevationOf(cloud, static_cast<std::size_t>(lines.index[n])) -
                       elevationOf(cloud, static_cast<std::size_t>(lines.index[n - 1])));
    }
    return tilt / static_cast<double>(begin.size() + 1);
  }

  /// Fraction of the steps that go in the prevailing direction.
  [[nodiscard]] float confidence() const
  {
    const std::size_t right_steps = std::max(rising, falling) + (rises() ? jumps_down : jumps_up);
    const std::size_t steps = rising + falling + jumps_up + jumps_down;
    return steps == 0 ? 0.0F : static_cast<float>(right_steps) / static_cast<float>(steps);
  }

  [[nodiscard]] bool isPlausible() const
  {
    constexpr float kFileOrderConfidence = 0.95F;  // other orders of points give about one half
    return confidence() >= kFileOrderConfidence && begin.size() + 1 >= 4 && begin.size() + 1 <= kMaxScanLines;
  }
};

/// The measurable points, in the cloud's order.
void listMeasurable(const CloudView& cloud, std::vector<std::int32_t>& index)
{
  index.resize(cloud.size);
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    index[count] = static_cast<std::int32_t>(i);
    count += isMeasurable(cloud, i) ? 1U : 0U;
  }
  index.resize(count);
}

/// The run that begins with the measurable point number \p place.
void readRun(const CloudView& cloud, const std::vector<std::int32_t>& index, std::size_t place, PointRun& run)
{
  run.place = place;
  run.count = std::min(PointRun::kMost, index.size() - place);
  for (std::size_t n = 0; n < run.count; ++n) {
    const auto i = static_cast<std::size_t>(index[place + n]);
    run.x[n] = cloud.x(i);
    run.y[n] = cloud.y(i);
  }
  computeAzimuths(run.count, run.x.data(), run.y.data(), run.azimuth.data());
}

/// Points of the same azimuth stay in the order of their numbers.
void sortByAzimuth(const CloudView& cloud, std::int32_t* points, std::size_t count)
{
  std::vector<std::uint64_t> keys(count);  // azimuth, whose bits rise with it, since it is not negative; and number
  for (std::size_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(points[n]);
    const float azimuth = pseudoAzimuth(cloud.x(i), cloud.y(i)) + 0.0F;  // no negative zero
    std::uint32_t bits = 0;
    std::memcpy(&bits, &azimuth, sizeof(bits));
    keys[n] = std::uint64_t{bits} << 32U | i;
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
  const auto line_count = static_cast<std::ptrdiff_t>(lines.lines());
  std::size_t rising = 0;
  std::size_t falling = 0;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(+ : rising, falling)
  for (std::ptrdiff_t line = 0; line < line_count; ++line) {
    const auto m = static_cast<std::size_t>(line);
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
  for (std::ptrdiff_t line = 0; line < line_count; ++line) {
    const auto m = static_cast<std::size_t>(line);
    sortByAzimuth(cloud, lines.index.data() + lines.begin[m],
                  static_cast<std::size_t>(lines.begin[m + 1] - lines.begin[m]));
  }
}

bool linesFromRingField(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, ScanLines& lines)
{
  if (!cloud.ring.exists()) {
    return false;
  }
  LineGrouping grouping(cloud.size, threads);
  withReader(cloud.ring, [&](const auto& ring_of) {
    grouping.assign([&](std::size_t i) {
      if (!isMeasurable(cloud, i)) {
        return LineGrouping::kNotMeasurable;
      }
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

bool linesFromOrganizedRows(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, ScanLines& lines)
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
  LineGrouping grouping(cloud.size, threads);
  grouping.assign([&](std::size_t i) {
    if (!isMeasurable(cloud, i)) {
      return LineGrouping::kNotMeasurable;
    }
    return static_cast<int>(lines.transposed ? i % cloud.width : i / cloud.width);
  });
  grouping.list(static_cast<int>(line_count), lines);
  ensureSweepOrder(cloud, lines, threads);
  // Depth images are organised too, but their rows do not run around the sensor in one direction unless seen so;
  // either way neighbours in a row are neighbours on the surface, which is all that is needed.
  return true;
}

bool linesFromFileOrder(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, ScanLines& lines)
{
  listMeasurable(cloud, lines.index);
  struct Cuts {
    OrderCut front;
    OrderCut rear;
  };
  constexpr std::size_t kStep = PointRun::kMost - 1;
  const std::size_t runs = (lines.index.size() + kStep - 1) / kStep;
  const auto parts = static_cast<std::size_t>(threads);
  std::vector<Cuts> cuts(parts);
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (std::ptrdiff_t p = 0; p < static_cast<std::ptrdiff_t>(parts); ++p) {
    const auto part = static_cast<std::size_t>(p);
    PointRun run;
    StepCounts front;
    StepCounts rear;
    for (std::size_t r = runs * part / parts; r < runs * (part + 1) / parts; ++r) {
      readRun(cloud, lines.index, r * kStep, run);
      countSteps(run.count, run.azimuth.data(), front, rear);
      cuts[part].front.advance(run, front, [](float before, float after) { return after - before; });
      cuts[part].rear.advance(run, rear, stepFromRear);
    }
  }
  for (std::size_t part = 1; part < parts; ++part) {
    cuts.front().front.append(cuts[part].front);
    cuts.front().rear.append(cuts[part].rear);
  }
  const OrderCut& front = cuts.front().front;
  const OrderCut& rear = cuts.front().rear;
  // Turned by half a turn, the order looks as good; but only where lines really end does the elevation change.
  const bool is_rear =
      rear.isPlausible() && !(front.isPlausible() && front.meanTilt(cloud, lines) >= rear.meanTilt(cloud, lines));
  const OrderCut& cut = is_rear ? rear : front;
  if (!cut.isPlausible()) {
    return false;
  }
  lines.begin.assign(1, 0);
  lines.begin.insert(lines.begin.end(), cut.begin.begin(), cut.begin.end());
  lines.begin.push_back(static_cast<std::int32_t>(lines.index.size()));
  lines.confidence = cut.confidence();
  lines.kitti_order = !is_rear && cut.rises();
  return true;
}

}  // namespace pcl_floam
