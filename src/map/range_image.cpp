#include "map/range_image.h"

#include "common/azimuth.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pcl_floam {

void RangeImage::take(const std::vector<Eigen::Vector3f>& points)
{
  nearest_.assign(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  beam_.resize(nearest_.size());
  farthest_.assign(nearest_.size() / kPatch / kPatch, 0.0F);
  for (const Eigen::Vector3f& point : points) {
    const float range = point.norm();
    if (!std::isfinite(range)) {
      continue;
    }
    const Cell cell = cellOf(point);
    if (cell.row < 0 || cell.row >= kRows) {
      continue;
    }
    const std::size_t place = placeOf(cell.column, cell.row, kRows);
    if (nearest_[place] == 0.0F || range < nearest_[place]) {
      nearest_[place] = range;
      beam_[place] = point / range;
    }
    float& farthest = farthest_[placeOf(cell.column / kPatch, cell.row / kPatch, kRows / kPatch)];
    farthest = std::max(farthest, range);
  }
}

RangeImage::Cell RangeImage::cellOf(const Eigen::Vector3f& direction)
{
  const float slope = direction.z() / std::sqrt(direction.x() * direction.x() + direction.y() * direction.y());
  if (!(std::abs(slope) < kSteepest)) {  // NaN, too
    return {0, -1};
  }
  const float azimuth = pseudoAzimuth(direction.x(), direction.y()) * (kColumns / 4.0F);
  return {std::min(static_cast<int>(azimuth), kColumns - 1),
          static_cast<int>((slope + kSteepest) * (kRows / (2.0F * kSteepest)))};
}

float RangeImage::clearlyBeyond(float range)
{
  constexpr float kFarther = 1.15F;
  constexpr float kClearlyFarther = 0.5F;  // m
  return kFarther * range + kClearlyFarther;
}

bool RangeImage::maySeeThrough(const Eigen::Vector3f& center, float radius) const
{
  constexpr float kPatchColumnsPerUnit = kColumns / 4.0F / kPatch;
  constexpr float kPatchRowsPerUnit = kRows / (2.0F * kSteepest) / kPatch;
  constexpr int kPatchColumns = kColumns / kPatch;
  const float across = std::sqrt(center.x() * center.x() + center.y() * center.y());
  if (across < 4.0F * radius) {  // it fills much of the view
    return true;
  }
  // The pseudo-azimuth changes by no more than the azimuth does.
  const float half_width = radius / (across - radius);
  const float slope = center.z() / across;
  const float column = pseudoAzimuth(center.x(), center.y()) * kPatchColumnsPerUnit;
  const float row = (slope + kSteepest) * kPatchRowsPerUnit;
  const float columns = half_width * kPatchColumnsPerUnit;
  const float rows = half_width * (1.0F + std::abs(slope)) * kPatchRowsPerUnit;
  const int first_row = std::max(static_cast<int>(std::floor(row - rows)), 0);
  const int last_row = std::min(static_cast<int>(std::floor(row + rows)), kRows / kPatch - 1);
  const int first_column = static_cast<int>(std::floor(column - columns));
  const int last_column = static_cast<int>(std::floor(column + columns));
  const float far = clearlyBeyond(center.norm() - radius);
  for (int c = first_column; c <= last_column; ++c) {
    const int wrapped = (c + kPatchColumns) % kPatchColumns;
    for (int r = first_row; r <= last_row; ++r) {
      if (farthest_[placeOf(wrapped, r, kRows / kPatch)] >= far) {
        return true;
      }
    }
  }
  return false;
}

/// True if no return of the row, near the column, is nearer than \p range.
bool RangeImage::allBeyond(int column, int row, float range) const
{
  for (int step = -1; step <= 1; ++step) {
    const float nearest = rangeAt((column + step + kColumns) % kColumns, row);
    if (nearest != 0.0F && nearest < range) {
      return false;
    }
  }
  return true;
}

/// The same for the next line of the scan above or below. A beam that passes just above a floor goes on far beyond,
/// too; but the line below it does not.
bool RangeImage::nextBeyond(const Cell& cell, int up, float range) const
{
  constexpr int kMostRows = 6;  // 4 degrees: next to the horizon, scan lines are closer together
  for (int row = cell.row + up; row >= 0 && row < kRows && std::abs(row - cell.row) <= kMostRows; row += up) {
    if (!allBeyond(cell.column, row, range)) {
      return false;
    }
    if (rangeAt(cell.column, row) != 0.0F) {
      return true;
    }
  }
  return true;
}

bool RangeImage::seesThrough(const Eigen::Vector3f& place) const
{
  const Cell cell = cellOf(place);
  if (cell.row < 0 || cell.row >= kRows) {
    return false;
  }
  const float range = place.norm();
  const float far = clearlyBeyond(range);
  if (rangeAt(cell.column, cell.row) < far ||  // or there is none
      !allBeyond(cell.column, cell.row, far) || !nextBeyond(cell, 1, far) || !nextBeyond(cell, -1, far)) {
    return false;
  }
  constexpr float kThrough = 0.05F;           // m from the beam
  constexpr float kThroughPerRange = 0.012F;  // rad: a cell
  const Eigen::Vector3f& beam = beam_[placeOf(cell.column, cell.row, kRows)];
  return (place - beam.dot(place) * beam).norm() < std::max(kThrough, kThroughPerRange * range);
}

}  // namespace pcl_floam
