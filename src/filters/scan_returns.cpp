#include "filters/scan_returns.h"

#include "filters/scan_line_finders.h"

#include <pcl_floam/filters/core/vertical_angle.h>

#include <algorithm>

namespace pcl_floam {

namespace {

/// Without scan lines: what is measured in one go, as points of a cloud follow each other, is one curve on what it
/// hits, as that of a laser; a pattern that returns to a place has drawn another one meanwhile. As many as supports
/// tell apart.
constexpr std::size_t kCurves = 64;

/// \return 1, or 0 if the point is out of range
inline std::size_t take(const CloudView& cloud, const RangeLimits& squared, std::size_t i, std::size_t n,
                        ReturnBatch& batch)
{
  const float x = cloud.x(i);
  const float y = cloud.y(i);
  const float z = cloud.z(i);
  const float range = x * x + y * y + z * z;
  batch.x[n] = x;
  batch.y[n] = y;
  batch.z[n] = z;
  batch.index[n] = static_cast<std::int32_t>(i);
  return range >= squared.nearest && range <= squared.farthest ? 1 : 0;  // refuses NaN, too
}

}  // namespace

ReturnReader::ReturnReader(const ScanReturns& returns)
    : returns_(returns), limits_{returns.min_range * returns.min_range, returns.max_range * returns.max_range}
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
  // Copies, no longer in memory: what is written to the batch might otherwise change them.
  const CloudView cloud = returns_.cloud;
  const RangeLimits limits = limits_;
  const std::int32_t* index = lines.index.data();
  std::size_t count = 0;
  for (std::size_t place = place_; place < end; ++place) {
    batch.place[count] = static_cast<std::int32_t>(place);
    count += take(cloud, limits, static_cast<std::size_t>(index[place]), count, batch);
  }
  place_ = end;
  std::fill_n(batch.laser.begin(), count, static_cast<std::uint32_t>(line_));
  batch.count = count;
  line_ += place_ == line_end ? 1 : 0;
}

void ReturnReader::readCloud(ReturnBatch& batch)
{
  const std::size_t size = returns_.cloud.size;
  const std::size_t end = std::min(size, place_ + ReturnBatch::kMost);
  // In a single layer a curve is all that there is of what it hits, so each return testifies for itself.
  const std::size_t curves = returns_.lines.failure == ScanLineFailure::single_layer ? size : kCurves;
  for (; place_ < end; ++place_) {
    if (isMeasurable(returns_.cloud, place_)) {
      batch.laser[batch.count] = static_cast<std::uint32_t>(curves * place_ / size);
      batch.place[batch.count] = -1;
      batch.count += take(returns_.cloud, limits_, place_, batch.count, batch);
    }
  }
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

}  // namespace pcl_floam
