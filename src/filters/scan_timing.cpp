#include <pcl_floam/filters/core/scan_timing.h>

#include "common/azimuth.h"
#include "common/field_type.h"
#include "common/multi_version.h"
#include "common/pi.h"
#include "filters/point_times.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_floam {

const char* toString(ScanTimingSource source)
{
  switch (source) {
    case ScanTimingSource::automatic: return "automatic";
    case ScanTimingSource::time_field: return "time field";
    case ScanTimingSource::columns: return "columns";
    case ScanTimingSource::azimuth: return "azimuth";
    case ScanTimingSource::clockwise: return "azimuth, clockwise";
    case ScanTimingSource::counterclockwise: return "azimuth, counterclockwise";
    case ScanTimingSource::none: return "none";
  }
  return "unknown";
}

namespace {

/// Seconds per unit of a time field whose values span \p span units.
double timeUnit(double span, FieldView::Type type)
{
  // A sweep lasts between 1/100 s and some seconds: of the units that drivers use, only one fits.
  constexpr double kShortest = 0.005;
  constexpr double kLongest = 5.0;
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (span * unit >= kShortest && span * unit < kLongest) {
      return unit;
    }
  }
  const bool real = type == FieldView::Type::float32 || type == FieldView::Type::float64;
  return real ? 1.0 : 1e-9;
}

bool timingFromField(const CloudView& cloud, int threads, ScanTiming& timing)
{
  if (!cloud.time.exists()) {
    return false;
  }
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  withReader(cloud.time, [&](const auto& time_of) {
#pragma omp parallel for num_threads(threads) schedule(static) reduction(min : first) reduction(max : last)
    for (std::size_t i = 0; i < cloud.size; ++i) {
      const double t = time_of(cloud.point(i));
      if ((t < first || t > last) && std::isfinite(t) && isMeasurable(cloud, i)) {
        first = std::min(first, t);
        last = std::max(last, t);
      }
    }
  });
  if (!(last > first)) {  // empty, or a field that the driver left constant
    return false;
  }
  // Times after the sweep's start begin near zero: then zero is the start, also when the first returns are missing. A
  // sensor that sees 120 degrees ahead begins a third into the turn, as late as its returns last: it must not waver.
  constexpr double kNearZero = 0.75;  // of the time that the returns last
  if (first > 0.0 && first < kNearZero * (last - first)) {
    first = 0.0;
  }
  timing.source = ScanTimingSource::time_field;
  timing.seconds_per_unit = timeUnit(last - first, cloud.time.type);
  timing.start = first * timing.seconds_per_unit;
  timing.duration = (last - first) * timing.seconds_per_unit;
  return true;
}

/// +1 if azimuth rises along the lines (counterclockwise seen from above), -1 if it falls, 0 if neither.
int lineDirection(const CloudView& cloud, const ScanLines& lines)
{
  long balance = 0;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    for (std::int32_t n = lines.begin[m] + 8; n < lines.begin[m + 1]; n += 8) {
      const auto a = static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n) - 8]);
      const auto b = static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n)]);
      const float cross = cloud.x(a) * cloud.y(b) - cloud.y(a) * cloud.x(b);
      balance += cross > 0.0F ? 1 : (cross < 0.0F ? -1 : 0);
    }
  }
  return balance > 0 ? 1 : (balance < 0 ? -1 : 0);
}

/// Whether points stand in the cloud in the order of their azimuth, as far as it goes round once.
bool isInFiringOrder(const CloudView& cloud, const ScanTiming& timing)
{
  constexpr std::size_t kSamples = 64;
  constexpr double kNear = 0.1;  // turns
  std::size_t seen = 0;
  std::size_t in_place = 0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const std::size_t i = k * cloud.size / kSamples;
    if (!isMeasurable(cloud, i)) {
      continue;
    }
    ++seen;
    const double azimuth = azimuthInTurns(cloud.x(i), cloud.y(i));
    const double start = timing.start_azimuth / kTwoPi;
    const double off =
        (timing.clockwise ? start - azimuth : azimuth - start) - static_cast<double>(k) / static_cast<double>(kSamples);
    in_place += std::abs(off - std::round(off)) < kNear ? 1 : 0;
  }
  return 2 * in_place > seen;
}

}  // namespace

bool goesRound(const CloudView& cloud, const ScanLines& lines)
{
  constexpr std::size_t kSectors = 36;
  constexpr std::size_t kStep = 7;  // points: some thousand are enough; odd, since drivers' habits are even
  std::array<bool, kSectors> is_seen{};
  std::size_t seen = 0;
  for (std::size_t n = 0; n < lines.index.size() && 2 * seen <= kSectors; n += kStep) {
    const auto i = static_cast<std::size_t>(lines.index[n]);
    const auto sector = static_cast<std::size_t>(azimuthInTurns(cloud.x(i), cloud.y(i)) * kSectors) % kSectors;
    seen += is_seen[sector] ? 0 : 1;
    is_seen[sector] = true;
  }
  return 2 * seen > kSectors;
}

namespace {

bool timingFromColumns(const CloudView& cloud, const ScanLines& lines, ScanTiming& timing)
{
  if (lines.source != ScanLineSource::organized_rows || lines.transposed || lines.sorted_by_azimuth ||
      cloud.width < 2) {
    return false;
  }
  timing.source = ScanTimingSource::columns;
  return true;
}

bool timingFromAzimuth(const CloudView& cloud, const ScanLines& lines, ScanTimingSource source, ScanTiming& timing)
{
  const bool is_clockwise = source == ScanTimingSource::clockwise;
  const bool is_given = is_clockwise || source == ScanTimingSource::counterclockwise;
  if (!lines.valid()) {
    return false;
  }
  const bool order_shows_rotation = !lines.kitti_order && !lines.sorted_by_azimuth;
  if (lines.kitti_order) {
    timing.clockwise = true;
    timing.start_azimuth = 0.5 * kTwoPi;
  } else if (order_shows_rotation) {
    const int direction = lineDirection(cloud, lines);
    if (direction == 0 && !is_given) {
      return false;
    }
    timing.clockwise = direction < 0;
    const std::size_t first = firstMeasurable(cloud);
    timing.start_azimuth =
        first < cloud.size ? std::atan2(static_cast<double>(cloud.y(first)), static_cast<double>(cloud.x(first))) : 0.0;
    const bool is_against = is_given && timing.clockwise != is_clockwise;
    timing.firing_order = !is_against && isInFiringOrder(cloud, timing);
  } else if (!is_given) {
    return false;  // sorted afterwards: nothing tells where the sweep began or which way it went
  } else {
    timing.start_azimuth = 0.5 * kTwoPi;
  }
  if (is_given) {
    timing.clockwise = is_clockwise;
  }
  timing.source = ScanTimingSource::azimuth;
  return true;
}

/// Fractions of a turn since the start.
PCL_FLOAM_MULTI_VERSION
void fractionsOfATurn(double start, bool clockwise, std::size_t count, const float* x, const float* y,
                      double* fractions)
{
  const double sign = clockwise ? -1.0 : 1.0;
  for (std::size_t n = 0; n < count; ++n) {
    const double since = sign * (static_cast<double>(azimuthInTurns(x[n], y[n])) - start);
    fractions[n] = since - std::floor(since);
  }
}

/// Around the seam the same azimuth comes twice; the place in the cloud tells which of the two it is.
double besideSeam(double fraction, double place)
{
  if (fraction > 0.75 && place < 0.25) {
    return 0.0;
  }
  return fraction < 0.25 && place > 0.75 ? 1.0 : fraction;
}

/// \param count no more than \ref kTimesAtOnce
void timesByAzimuth(const CloudView& cloud, const ScanTiming& timing, const std::int32_t* index, std::size_t count,
                    float* times)
{
  std::array<float, kTimesAtOnce> x{};
  std::array<float, kTimesAtOnce> y{};
  std::array<double, kTimesAtOnce> fractions;
  for (std::size_t n = 0; n < count; ++n) {
    x[n] = cloud.x(static_cast<std::size_t>(index[n]));
    y[n] = cloud.y(static_cast<std::size_t>(index[n]));
  }
  fractionsOfATurn(timing.start_azimuth / kTwoPi, timing.clockwise, count, x.data(), y.data(), fractions.data());
  for (std::size_t n = 0; n < count; ++n) {
    const double place = static_cast<double>(index[n]) / static_cast<double>(cloud.size);
    const double fraction = timing.firing_order ? besideSeam(fractions[n], place) : fractions[n];
    times[n] = std::isfinite(fraction) ? static_cast<float>(fraction) : 1.0F;
  }
}

}  // namespace

void timesOf(const CloudView& cloud, const ScanTiming& timing, const std::int32_t* index, std::size_t count,
             float* times)
{
  if (timing.source == ScanTimingSource::time_field) {
    withReader(cloud.time, [&](const auto& time_of) {
      for (std::size_t n = 0; n < count; ++n) {
        times[n] = timing.fractionOf(time_of(cloud.point(static_cast<std::size_t>(index[n]))));
      }
    });
  } else if (timing.source == ScanTimingSource::azimuth) {
    for (std::size_t begin = 0; begin < count; begin += kTimesAtOnce) {
      timesByAzimuth(cloud, timing, index + begin, std::min(kTimesAtOnce, count - begin), times + begin);
    }
  } else if (timing.valid()) {
    for (std::size_t n = 0; n < count; ++n) {
      times[n] = timing.at(cloud, static_cast<std::size_t>(index[n]));
    }
  }
}

float ScanTiming::at(const CloudView& cloud, std::size_t i) const
{
  if (source == ScanTimingSource::time_field) {
    return fractionOf(cloud.time.read(cloud.point(i)));
  }
  if (source == ScanTimingSource::azimuth) {
    const auto index = static_cast<std::int32_t>(i);
    float time = 0.0F;
    timesByAzimuth(cloud, *this, &index, 1, &time);
    return time;
  }
  return source == ScanTimingSource::columns
             ? withinSweep(static_cast<double>(i % cloud.width) / static_cast<double>(cloud.width - 1))
             : 1.0F;
}

double ScanTiming::sinceStamp(double fraction, double stamp) const
{
  constexpr double kNear = 10.0;  // s: no two clocks agree so well by chance
  if (source != ScanTimingSource::time_field) {
    return 0.0;
  }
  const double within = fraction * duration;
  if (std::abs(start - stamp) < std::min(kNear, std::abs(start))) {
    return start - stamp + within;
  }
  return std::abs(start) <= 2.0 * duration ? start + within : within;
}

ScanTiming findScanTiming(const CloudView& cloud, const ScanLines& lines, ScanTimingSource source, int threads)
{
  ScanTiming timing;
  const bool any = source == ScanTimingSource::automatic;
  const bool by_azimuth = source == ScanTimingSource::azimuth || source == ScanTimingSource::clockwise ||
                          source == ScanTimingSource::counterclockwise;
  const bool is_found =
      ((any || source == ScanTimingSource::time_field) && timingFromField(cloud, std::max(threads, 1), timing)) ||
      ((any || source == ScanTimingSource::columns) && timingFromColumns(cloud, lines, timing)) ||
      ((by_azimuth || (any && goesRound(cloud, lines))) && timingFromAzimuth(cloud, lines, source, timing));
  return is_found ? timing : ScanTiming();
}

}  // namespace pcl_floam
