/// \file scan_timing.h
/// When within the sweep each point was measured.
#pragma once

#include <pcl_floam/common/cloud_view.h>
#include <pcl_floam/filters/scan_lines.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Where the points' times come from.
enum class ScanTimingSource : std::uint8_t {
  automatic,   ///< the time field, else the organised columns, else the azimuth
  time_field,  ///< a field `time`, `t`, `timestamp`, ...: s, us or ns, relative or absolute
  columns,     ///< the columns of an organised cloud: one column is one firing
  azimuth,     ///< the azimuth, with the direction of rotation measured from the firing order
  none         ///< all points at the same instant: the scan is compensated already, or not rotating
};

[[nodiscard]] const char* toString(ScanTimingSource source);

/// Sense of the head's rotation seen from above (+z towards the viewer).
enum class ScanRotation : std::uint8_t { automatic, clockwise, counterclockwise };

/// Each point's time as a fraction of the sweep.
struct ScanTiming {
  std::vector<float> time;  ///< one per point of the cloud, in [0,1]: 0 = start, 1 = end; 0 where unknown
  ScanTimingSource source = ScanTimingSource::none;
  double start = 0.0;     ///< seconds, of the first measurement in the time field's own clock; 0 without one
  double duration = 0.0;  ///< seconds from time 0 to time 1; 0 where it is not known (one turn then)
  bool valid() const { return source != ScanTimingSource::none; }
};

/// Finds the points' times.
///
/// Without a time field, KITTI's convention is used for clouds in file order, which do not show the firing
/// order: the head turns clockwise, the sweep begins and ends at the rear.
///
/// \param cloud    one scan in the sensor's frame
/// \param lines    its scan lines; their order shows the direction of rotation
/// \param source   `automatic`, or the one source to use
/// \param rotation `automatic` to measure it, else the given one; used by source `azimuth` only
/// \param[out] timing overwritten; `source` is `none` when no time can be told
void findScanTiming(const CloudView& cloud, const ScanLines& lines, ScanTimingSource source, ScanRotation rotation,
                    ScanTiming& timing);

}  // namespace pcl_floam
