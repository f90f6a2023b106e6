#include <pcl_floam/filters/scan_points.h>

#include "filters/point_times.h"
#include "filters/scan_line_finders.h"
#include "filters/scan_returns.h"

#include <pcl_floam/filters/vertical_angle.h>

#include <algorithm>

namespace pcl_floam {

ReturnReader::ReturnReader(const ScanReturns& returns)
    : returns_(returns),
      nearest_(static_cast<float>(returns.min_range * returns.min_range)),
      farthest_(static_cast<float>(returns.max_range * returns.max_range))
{
}

bool ReturnReader::next(ReturnBatch& batch)
{
  const ScanLines& lines = returns_.lines;
  batch.count = 0;
  while (batch.count == 0 && (lines.valid() ? line_ < lines.lines() : place_ < returns_.cloud.size)) {
    lines.valid() ? readLine(batch) : readCloud(batch);
  }
  correctVerticalAngle(returns_.vertical_correction, batch.count, batch.x.data(), batch.y.data(), batch.z.data());
  return batch.count > 0;
}

void ReturnReader::readLine(ReturnBatch& batch)
{
  const ScanLines& lines = returns_.lines;
  const auto line_end = static_cast<std::size_t>(lines.begin[line_ + 1]);
  const std::size_t end = std::min(line_end, place_ + ReturnBatch::kMost);
  std::size_t count = 0;  // no longer in memory
  for (; place_ < end; ++place_) {
    count += take(static_cast<std::size_t>(lines.index[place_]), count, batch);
  }
  std::fill_n(batch.laser.begin(), count, static_cast<std::uint32_t>(line_));
  batch.count = count;
  line_ += place_ == line_end ? 1 : 0;
}

void ReturnReader::readCloud(ReturnBatch& batch)
{
  const std::size_t end = std::min(returns_.cloud.size, place_ + ReturnBatch::kMost);
  for (; place_ < end; ++place_) {
    if (isMeasurable(returns_.cloud, place_)) {
      batch.laser[batch.count] = static_cast<std::uint32_t>(place_);
      batch.count += take(place_, batch.count, batch);
    }
  }
}

/// \return 1, or 0 if the point is out of range
inline std::size_t ReturnReader::take(std::size_t i, std::size_t n, ReturnBatch& batch) const
{
  const float x = returns_.cloud.x(i);
  const float y = returns_.cloud.y(i);
  const float z = returns_.cloud.z(i);
  const float squared = x * x + y * y + z * z;
  batch.x[n] = x;
  batch.y[n] = y;
  batch.z[n] = z;
  batch.index[n] = static_cast<std::int32_t>(i);
  return squared >= nearest_ && squared <= farthest_ ? 1 : 0;  // refuses NaN, too
}

bool ScanReturns::areAtLeast(std::size_t count) const
{
  ReturnReader reader(*this);
  ReturnBatch batch;
  std::size_t seen = 0;
  while (seen < count && reader.next(batch)) {
    seen += batch.count;
  }
  return seen >= count;
}

void collectPoints(const ScanReturns& returns, std::vector<ScanPoint>& points)
{
  points.clear();
  points.reserve(returns.lines.valid() ? returns.lines.index.size() : returns.cloud.size);
  ReturnReader reader(returns);
  for (ReturnBatch batch; reader.next(batch);) {
    for (std::size_t n = 0; n < batch.count; ++n) {
      points.push_back(batch.point(n));
    }
  }
  setTimes(returns.cloud, returns.timing, points);
}

}  // namespace pcl_floam
