// Scan lines that follow each other in the cloud, one turn of the sensor after the other.
#include "common/azimuth.h"
#include "common/multi_version.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pcl_floam {

namespace {

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

/// Where azimuth turns over.
enum class Seam { front, rear };

inline float stepBetween(float before, float after, Seam seam)
{
  return seam == Seam::front ? after - before : turnedByHalf(after) - turnedByHalf(before);
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
    count(stepBetween(azimuth[n - 1], azimuth[n], Seam::front), from_front);
    count(stepBetween(azimuth[n - 1], azimuth[n], Seam::rear), from_rear);
  }
  front = from_front;
  rear = from_rear;
}

/// The scan lines that result if the cloud's order is cut wherever azimuth jumps back by most of a turn.
struct OrderCut {
  explicit OrderCut(Seam azimuth_seam) : seam(azimuth_seam) {}

  Seam seam;
  std::array<std::int32_t, kMaxScanLines> begin{};  ///< of the lines but the first; more of them are not plausible
  std::size_t begun = 0;
  std::size_t rising = 0;
  std::size_t falling = 0;
  std::size_t jumps_up = 0;
  std::size_t jumps_down = 0;

  [[nodiscard]] auto afterLast() const { return begin.begin() + static_cast<std::ptrdiff_t>(begun); }

  void take(std::int32_t place)
  {
    if (begun < begin.size()) {
      begin[begun++] = place;
    }
  }

  /// Adds the steps within a run; the next run begins with this one's last point.
  void advance(const PointRun& run, const StepCounts& counts)
  {
    rising += static_cast<std::size_t>(counts.rising);
    falling += static_cast<std::size_t>(counts.falling);
    for (std::size_t n = 1; n < run.count && counts.jumps > 0; ++n) {
      const float step = stepBetween(run.azimuth[n - 1], run.azimuth[n], seam);
      if (std::abs(step) > kJump) {
        (step > 0.0F ? jumps_up : jumps_down)++;
        take(static_cast<std::int32_t>(run.place + n));
      }
    }
  }

  /// Adds the steps of the cloud's next part.
  void append(const OrderCut& next)
  {
    std::for_each(next.begin.begin(), next.afterLast(), [this](std::int32_t place) { take(place); });
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
    for (std::size_t m = 0; m < begun; ++m) {
      const auto n = static_cast<std::size_t>(begin[m]);
      tilt += std::abs(elevationOf(cloud, static_cast<std::size_t>(lines.index[n])) -
                       elevationOf(cloud, static_cast<std::size_t>(lines.index[n - 1])));
    }
    return tilt / static_cast<double>(begun + 1);
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
    return confidence() >= kFileOrderConfidence && begun + 1 >= 4 && begun + 1 <= kMaxScanLines;
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

/// The cuts at either seam.
struct Cuts {
  OrderCut front{Seam::front};
  OrderCut rear{Seam::rear};

  void append(const Cuts& next)
  {
    front.append(next.front);
    rear.append(next.rear);
  }

  /// Turned by half a turn, the order looks as good; but only where lines really end does the elevation change.
  [[nodiscard]] const OrderCut& better(const CloudView& cloud, const ScanLines& lines) const
  {
    const bool is_rear =
        rear.isPlausible() && !(front.isPlausible() && front.meanTilt(cloud, lines) >= rear.meanTilt(cloud, lines));
    return is_rear ? rear : front;
  }
};

Cuts cutsOf(const CloudView& cloud, const std::vector<std::int32_t>& index, int threads)
{
  constexpr std::size_t kStep = PointRun::kMost - 1;
  const std::size_t runs = (index.size() + kStep - 1) / kStep;
  const auto parts = static_cast<std::size_t>(threads);
  Cuts cuts;
#pragma omp parallel for ordered num_threads(threads) schedule(static, 1)
  for (std::size_t part = 0; part < parts; ++part) {
    Cuts found;
    PointRun run;
    StepCounts front;
    StepCounts rear;
    for (std::size_t r = runs * part / parts; r < runs * (part + 1) / parts; ++r) {
      readRun(cloud, index, r * kStep, run);
      countSteps(run.count, run.azimuth.data(), front, rear);
      found.front.advance(run, front);
      found.rear.advance(run, rear);
    }
#pragma omp ordered
    cuts.append(found);
  }
  return cuts;
}

}  // namespace

bool linesFromFileOrder(const CloudView& cloud, const SensorModel& /*sensor*/, int threads, LineGrouping& /*grouping*/,
                        ScanLines& lines)
{
  listMeasurable(cloud, lines.index);
  const Cuts cuts = cutsOf(cloud, lines.index, threads);
  const OrderCut& cut = cuts.better(cloud, lines);
  if (!cut.isPlausible()) {
    return false;
  }
  lines.begin.assign(1, 0);
  lines.begin.insert(lines.begin.end(), cut.begin.begin(), cut.afterLast());
  lines.begin.push_back(static_cast<std::int32_t>(lines.index.size()));
  lines.confidence = cut.confidence();
  lines.kitti_order = cut.seam == Seam::front && cut.rises();
  return true;
}

}  // namespace pcl_floam
