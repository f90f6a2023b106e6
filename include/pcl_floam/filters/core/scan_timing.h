/// \file scan_timing.h
/// When within the sweep each point was measured.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/scan_lines.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pcl_floam {

/// Where the points' times come from.
enum class ScanTimingSource : std::uint8_t {
  automatic,   ///< the time field, else the organised columns, else the azimuth of what sees more than half a turn
  time_field,  ///< a field `time`, `t`, `timestamp`, ...: s, ms, us or ns, relative or absolute
  columns,     ///< the columns of an organised cloud: one column is one firing
  azimuth,     ///< the azimuth, with the direction of rotation told by the firing order, or by \ref Odometry's poses
  clockwise,   ///< the azimuth, of a head that turns clockwise, seen from above (+z towards the viewer)
  counterclockwise,
  none  ///< all points at the same instant: the scan is compensated already, or not rotating
};

[[nodiscard]] const char* toString(ScanTimingSource source);

/// When each point was measured, as a fraction of the sweep.
///
/// A model, not a list: times are computed only for the points that are asked for.
struct ScanTiming {
  ScanTimingSource source = ScanTimingSource::none;  ///< `azimuth` also where the rotation was given
  double start = 0.0;                                ///< seconds, in the time field's own clock; 0 without one
  double duration = 0.0;          ///< seconds from fraction 0 to fraction 1; 0 where not known (one turn then)
  double seconds_per_unit = 1.0;  ///< of the time field
  double start_azimuth = 0.0;     ///< rad; source `azimuth`: where the sweep begins
  bool clockwise = true;          ///< source `azimuth`: seen from above
  /// Source `azimuth`: the cloud's order is the firing order, which tells the sweep's first points from its last.
  bool firing_order = false;

  [[nodiscard]] bool valid() const { return source != ScanTimingSource::none; }

  /// Fraction of the sweep in [0,1] at which point \p i was measured: 0 = start, 1 = end. Where it is unknown (no
  /// source, a time that is not finite) it is 1, the instant to which points are compensated by default.
  [[nodiscard]] float at(const CloudView& cloud, std::size_t i) const;

  /// The same for what stands in the time field, of source `time_field`.
  [[nodiscard]] float fractionOf(double time) const
  {
    return withinSweep((time * seconds_per_unit - start) / duration);
  }

  /// Seconds from a scan's stamp to a fraction of its sweep, as the time field tells: times may count from the stamp or
  /// by the stamp's own clock; if by another one, the stamp is taken for that of the sweep's start. 0 without a field.
  [[nodiscard]] double sinceStamp(double fraction, double stamp) const;

private:
  static float withinSweep(double fraction)
  {
    return std::isfinite(fraction) ? static_cast<float>(std::clamp(fraction, 0.0, 1.0)) : 1.0F;
  }
};

/// Finds out how the points' times can be told.
///
/// Without a time field, KITTI's convention is used for clouds in KITTI's file order, which does not show the
/// firing order: the head turns clockwise, the sweep begins and ends at the rear.
///
/// \param cloud   one scan in the sensor's frame
/// \param lines   its scan lines; their order shows the direction of rotation
/// \param source  `automatic`, or the one source to use
/// \param threads >= 1; the timing does not depend on it
/// \return a timing whose `source` is `none` when no time can be told
[[nodiscard]] ScanTiming findScanTiming(const CloudView& cloud, const ScanLines& lines,
                                        ScanTimingSource source = ScanTimingSource::automatic, int threads = 1);

}  // namespace pcl_floam
