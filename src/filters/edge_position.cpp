#include "filters/edge_position.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl_floam {

namespace {

/// A step to the next point that is longer than this part of the range leads to another surface.
constexpr float kSurfaceStep = 0.05F;

/// m; what is wider than this is a surface with two ends.
constexpr float kThin = 0.4F;

/// The middle of something is behind what is seen of it by A / (2 W), A being the area of its section and W the width
/// that is seen: 0.39 W for what is round, 0.25 W to 0.5 W for square posts, less for flat ones. Far away, only posts
/// that at least two beams happened to hit become edges, and look wider than they are, so that less is
/// taken.
constexpr float kAxisBehind = 0.25F;

/// rad; neighbours farther apart than this have lost returns between them.
constexpr float kNextBeam = 0.02F;

/// rad; between neighbours farther apart than this there is nothing, as before the sky. With less, walls would end
/// where a few returns are missing.
constexpr float kNothing = 0.1F;

/// m; no end of a surface is moved by more. Far away, its points are metres apart.
constexpr float kFarthestMove = 0.4F;

/// m; along a surface that the beams graze, points are farther apart than across them, and what stands out from it near
/// its end (a door's frame) is mostly missed: the end is nearer than half a step. So it is moved by no more than half
/// of what the beams are apart, or by this. Moved by half a step, far ends of a corridor's walls would lie
/// farther off than seen from beside, and the map stretch with each one.
constexpr float kGrazing = 0.05F;

/// Points from which the spacing at the end of a surface is taken.
constexpr int kForSpacing = 3;

/// Points on each side from which the corner of two surfaces is taken.
constexpr int kForCorner = 4;

/// Cosine of the angle between two surfaces, above which they nearly go on or fold back: where lines through them meet
/// is then anywhere along them.
constexpr float kFlatCorner = 0.75F;

/// As good as the angle where it is small, rad.
float angleBetween(const LinePoints& line, int a, int b)
{
  return (line.at(b).normalized() - line.at(a).normalized()).norm();
}

/// What is next to the last point of a surface.
enum class Border {
  none,    ///< the same surface: it was not followed to its end
  behind,  ///< something farther, or nothing: the surface ends here
  before   ///< something nearer, which may hide more of it, or the end of the scan line, behind which it may go on
};

/// A surface on one side of a point.
struct Side {
  int last;  ///< of its points
  Border border;
  int outward;  ///< 1 or -1
};

Border borderBetween(const LinePoints& line, int inner, int outer, float noise)
{
  if (outer < 0 || outer >= line.size()) {
    return Border::before;
  }
  const auto i = static_cast<std::size_t>(inner);
  const auto o = static_cast<std::size_t>(outer);
  const float limit = std::max(noise, kSurfaceStep * std::min(line.range[i], line.range[o]));
  if (line.squared_step[std::min(i, o)] < limit * limit) {
    return Border::none;
  }
  const bool is_farther = line.range[o] > line.range[i];
  return is_farther || angleBetween(line, inner, outer) > kNothing ? Border::behind : Border::before;
}

/// Follows the surface of point \p n until it ends, or is more than thin.
Side follow(const LinePoints& line, int n, int outward, float noise)
{
  const Eigen::Vector3f start = line.at(n);
  for (int k = n;; k += outward) {
    const Border border = borderBetween(line, k, k + outward, noise);
    if (border != Border::none || (line.at(k) - start).squaredNorm() > kThin * kThin) {
      return {k, border, outward};
    }
  }
}

/// The axis of something thin: in the middle of what is seen of it, and behind that.
std::optional<LineEdge> axisOf(const LinePoints& line, const Side& left, const Side& right)
{
  if (left.border != Border::behind || right.border != Border::behind ||
      (line.at(right.last) - line.at(left.last)).norm() > kThin) {
    return std::nullopt;
  }
  const int count = right.last - left.last + 1;
  const float seen = angleBetween(line, left.last, right.last);
  const float to_left = angleBetween(line, left.last - 1, left.last);
  const float to_right = angleBetween(line, right.last, right.last + 1);
  if (count == 1 && std::max(to_left, to_right) > kNextBeam) {
    return std::nullopt;
  }
  // It ends halfway to the next beams. Where these brought nothing back, they are as far as the ones that did.
  const float next = count > 1 ? 1.5F * seen / static_cast<float>(count - 1) : kNextBeam;
  const float angle = seen + 0.5F * (std::min(to_left, next) + std::min(to_right, next));
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (int k = left.last; k <= right.last; ++k) {
    middle += line.at(k);
  }
  middle /= static_cast<float>(count);
  const float width = angle * middle.norm();
  if (width > kThin) {
    return std::nullopt;
  }
  return LineEdge{middle + kAxisBehind * width * middle.normalized(), left.last, right.last};
}

/// Half a step beyond the last point of a surface, or less, whose \p other side has the points before it.
Eigen::Vector3f endOf(const LinePoints& line, const Side& side, const Side& other)
{
  Eigen::Vector3f last = line.at(side.last);
  const int steps = std::min(kForSpacing, std::abs(other.last - side.last));
  if (steps == 0) {
    return last;
  }
  const Eigen::Vector3f step = (last - line.at(side.last - side.outward * steps)) / static_cast<float>(steps);
  const float half = 0.5F * step.norm();
  const float half_across = 0.5F * step.cross(last.normalized()).norm();
  return half > 0.0F && half < kFarthestMove
             ? Eigen::Vector3f(last + std::min(half, std::max(kGrazing, half_across)) / half * 0.5F * step)
             : last;
}

struct StraightLine {
  Eigen::Vector3f center;
  Eigen::Vector3f direction;
};

/// Least squares over the points' places in the scan line.
StraightLine lineThrough(const LinePoints& line, int first, int last)
{
  const float middle = 0.5F * static_cast<float>(first + last);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f moment = Eigen::Vector3f::Zero();
  for (int k = first; k <= last; ++k) {
    sum += line.at(k);
    moment += (static_cast<float>(k) - middle) * line.at(k);
  }
  return {sum / static_cast<float>(last - first + 1), moment.normalized()};
}

/// Where the surfaces on both sides of point \p n meet; the point itself where that is not clear.
Eigen::Vector3f cornerAt(const LinePoints& line, int n, const Side& left, const Side& right)
{
  Eigen::Vector3f point = line.at(n);
  const int first = std::max(left.last, n - kForCorner);
  const int last = std::min(right.last, n + kForCorner);
  if (n - first < 2 || last - n < 2) {
    return point;
  }
  const StraightLine a = lineThrough(line, first, n - 1);
  const StraightLine b = lineThrough(line, n + 1, last);
  const float cosine = a.direction.dot(b.direction);
  if (a.direction.isZero() || b.direction.isZero() || std::abs(cosine) > kFlatCorner) {
    return point;
  }
  // In the middle between the points where the two are nearest to each other.
  const Eigen::Vector3f between = b.center - a.center;
  const float along_a = between.dot(a.direction);
  const float along_b = between.dot(b.direction);
  const float scale = 1.0F / (1.0F - cosine * cosine);
  const Eigen::Vector3f on_a = a.center + scale * (along_a - cosine * along_b) * a.direction;
  const Eigen::Vector3f on_b = b.center + scale * (cosine * along_a - along_b) * b.direction;
  const Eigen::Vector3f corner = 0.5F * (on_a + on_b);
  const auto k = static_cast<std::size_t>(n);
  const float farthest = std::max(line.squared_step[k - 1], line.squared_step[k]);
  return (corner - point).squaredNorm() <= farthest ? corner : point;
}

}  // namespace

LineEdge locateEdge(const LinePoints& line, int n, float noise)
{
  const Side left = follow(line, n, -1, noise);
  const Side right = follow(line, n, 1, noise);
  if (const auto axis = axisOf(line, left, right)) {
    return *axis;
  }
  LineEdge edge{line.at(n), n, n};
  const bool ends_left = left.last == n && left.border == Border::behind;
  const bool ends_right = right.last == n && right.border == Border::behind;
  if (ends_left != ends_right) {
    edge.position = ends_left ? endOf(line, left, right) : endOf(line, right, left);
  } else if (left.last < n && right.last > n) {
    edge.position = cornerAt(line, n, left, right);
  }
  return edge;
}

}  // namespace pcl_floam
