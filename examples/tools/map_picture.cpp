#include "map_picture.h"

#include "quantile.h"

#include <pcl/io/png_io.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

namespace pcl_floam::tools {

namespace {

constexpr double kTurn = 0.6;            // rad, about the vertical
constexpr double kSlant = 0.9;           // rad below the horizon that one looks
constexpr double kPictureMargin = 0.03;  // of the picture
constexpr double kQuantile =
    0.005;  // of the points on each side that may lie outside: far strays would shrink the rest

using Color = Eigen::Vector3d;

/// Coordinates in the picture: right, up, and towards the viewer, m.
Eigen::Matrix3d viewRotation()
{
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return Eigen::AngleAxisd(-(0.5 * M_PI - kSlant), Eigen::Vector3d::UnitX()).toRotationMatrix() * turned;
}

/// Blue at the bottom, by green and yellow, to red at the top.
Color colorOf(double part)
{
  static const std::array<Color, 5> kColors{Color(60.0, 80.0, 170.0), Color(45.0, 140.0, 165.0),
                                            Color(90.0, 185.0, 120.0), Color(230.0, 195.0, 85.0),
                                            Color(215.0, 85.0, 55.0)};
  const double place = 4.0 * std::clamp(part, 0.0, 1.0);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), 3);
  const double rest = place - static_cast<double>(below);
  return (1.0 - rest) * kColors[below] + rest * kColors[below + 1];
}

/// The picture while it is drawn, with each pixel's distance towards the viewer.
class Canvas {
public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        depth_(count(), -std::numeric_limits<double>::infinity()),
        color_(count(), Color(255.0, 255.0, 255.0))
  {
  }

  void square(double x, double y, double depth, double size, const Color& color)
  {
    const int half = std::max(0, static_cast<int>(0.5 * size));
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    for (int v = std::max(0, row - half); v <= std::min(height_ - 1, row + half); ++v) {
      for (int u = std::max(0, column - half); u <= std::min(width_ - 1, column + half); ++u) {
        if (depth > depth_[at(u, v)]) {
          depth_[at(u, v)] = depth;
          color_[at(u, v)] = color;
        }
      }
    }
  }

  /// Darkens what lies behind its neighbours: edges of things then show.
  [[nodiscard]] Picture shaded(double scale) const
  {
    Picture picture{width_, height_, {}};
    picture.rgb.reserve(3 * count());
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) {
        const Color color = std::exp(-hiddenBy(u, v) / scale) * color_[at(u, v)];
        for (Eigen::Index i = 0; i < 3; ++i) {
          picture.rgb.push_back(static_cast<std::uint8_t>(std::clamp(color[i], 0.0, 255.0)));
        }
      }
    }
    return picture;
  }

private:
  [[nodiscard]] std::size_t count() const
  {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  [[nodiscard]] std::size_t at(int u, int v) const
  {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }

  /// m, how far the neighbouring pixels stand out before this one, on average and at most 1 m each.
  [[nodiscard]] double hiddenBy(int u, int v) const
  {
    constexpr int kReach = 2;
    const double own = depth_[at(u, v)];
    if (!std::isfinite(own)) {
      return 0.0;
    }
    double sum = 0.0;
    for (const auto& [du, dv] :
         {std::pair(-kReach, 0), std::pair(kReach, 0), std::pair(0, -kReach), std::pair(0, kReach)}) {
      const int column = std::clamp(u + du, 0, width_ - 1);
      const int row = std::clamp(v + dv, 0, height_ - 1);
      const double other = depth_[at(column, row)];
      sum += std::isfinite(other) ? std::clamp(other - own, 0.0, 1.0) : 0.0;
    }
    return 0.25 * sum;
  }

  int width_, height_;
  std::vector<double> depth_;
  std::vector<Color> color_;
};

/// From the world to the picture's pixels.
struct View {
  Eigen::Matrix3d rotation;
  Eigen::Vector2d middle;  ///< m
  double scale = 1.0;      ///< pixels a metre

  View(const std::vector<Eigen::Vector3d>& points, int width, int height) : rotation(viewRotation())
  {
    std::array<std::vector<double>, 2> coordinates;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d seen = rotation * point;
      coordinates[0].push_back(seen.x());
      coordinates[1].push_back(seen.y());
    }
    const Eigen::Vector2d low(quantile(coordinates[0], kQuantile), quantile(coordinates[1], kQuantile));
    const Eigen::Vector2d high(quantile(coordinates[0], 1.0 - kQuantile), quantile(coordinates[1], 1.0 - kQuantile));
    const Eigen::Vector2d size = (high - low).cwiseMax(1.0);
    middle = 0.5 * (low + high);
    scale = (1.0 - 2.0 * kPictureMargin) * std::min(width / size.x(), height / size.y());
  }
};

std::vector<Eigen::Vector3d> cutOff(const MapScene& scene)
{
  double top = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place : scene.path) {
    top = std::max(top, place.z() + scene.cut);
  }
  std::vector<Eigen::Vector3d> kept;
  std::copy_if(scene.map.begin(), scene.map.end(), std::back_inserter(kept), [&](const Eigen::Vector3d& point) {
    return point.allFinite() && (scene.path.empty() || point.z() <= top);
  });
  return kept;
}

}  // namespace

Picture renderMap(const MapScene& scene, int width, int height)
{
  const std::vector<Eigen::Vector3d> map = cutOff(scene);
  std::vector<Eigen::Vector3d> all = map;
  all.insert(all.end(), scene.path.begin(), scene.path.end());
  Canvas canvas(width, height);
  if (all.empty()) {
    return canvas.shaded(1.0);
  }
  const View view(all, width, height);
  std::vector<double> heights;
  for (const Eigen::Vector3d& point : all) {
    heights.push_back(point.z());
  }
  const double bottom = quantile(heights, 0.02);
  const double span = std::max(quantile(heights, 0.98) - bottom, 0.1);
  const auto draw = [&](const Eigen::Vector3d& point, double lift, double size, const Color& color) {
    const Eigen::Vector3d seen = view.rotation * point;
    canvas.square(0.5 * width + view.scale * (seen.x() - view.middle.x()),
                  0.5 * height - view.scale * (seen.y() - view.middle.y()), seen.z() + lift, size, color);
  };
  for (const Eigen::Vector3d& point : map) {
    draw(point, 0.0, view.scale * scene.point_size, colorOf((point.z() - bottom) / span));
  }
  // The path is drawn over everything: it would be hidden where it passes below a roof's edge.
  constexpr double kAboveAll = 1e6;  // m
  for (const Eigen::Vector3d& place : scene.path) {
    draw(place, kAboveAll, 4.0, Color(20.0, 20.0, 20.0));
  }
  return canvas.shaded(1.0);
}

std::string drawMap(const MapScene& scene, const std::filesystem::path& image)
{
  if (scene.map.empty()) {
    return "the map is empty";
  }
  if (!std::ofstream(image)) {
    return "it cannot be written";  // VTK, which PCL writes pictures with, would tell a longer story on the console
  }
  const Picture picture = renderMap(scene);
  try {
    pcl::io::saveRgbPNGFile(image.string(), picture.rgb.data(), picture.width, picture.height);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace pcl_floam::tools
