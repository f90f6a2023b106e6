// The rendered picture of the map.

#include "support/temporary_folder.h"

#include "map_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>

namespace pcl_floam::tools {
namespace {

using test::TemporaryFolder;

constexpr std::array<std::uint8_t, 3> kWhite{255, 255, 255};

/// A floor of 10 x 10 m with a box on it, and a ceiling.
MapScene hall()
{
  MapScene scene;
  for (double x = -5.0; x <= 5.0; x += 0.1) {
    for (double y = -5.0; y <= 5.0; y += 0.1) {
      scene.map.emplace_back(x, y, 0.0);
      scene.map.emplace_back(x, y, 6.0);
    }
  }
  for (double x = 1.0; x <= 3.0; x += 0.1) {
    for (double z = 0.0; z <= 2.0; z += 0.1) {
      scene.map.emplace_back(x, 0.0, z);
    }
  }
  scene.path = {{-2.0, -2.0, 1.0}};
  return scene;
}

std::size_t countPixels(const Picture& picture, const std::array<std::uint8_t, 3>& color)
{
  std::size_t count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      count += picture.pixel(x, y) == color ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

TEST(MapPicture, ShowsFloorBoxAndPathUnderTheCutCeiling)
{
  const MapScene scene = hall();
  const Picture picture = renderMap(scene, 400, 300);
  ASSERT_EQ(picture.rgb.size(), 3U * 400U * 300U);
  const std::size_t background = countPixels(picture, kWhite);
  EXPECT_GT(background, 400U * 300U / 20U);
  EXPECT_LT(background, 400U * 300U * 4U / 5U);
  EXPECT_GT(countPixels(picture, {20, 20, 20}), 8U);
  bool red = false;
  bool blue = false;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto [r, g, b] = picture.pixel(x, y);
      red |= r > 150 && b < 100;
      blue |= b > 150 && r < 100;
    }
  }
  EXPECT_TRUE(red) << "the top of the box";
  EXPECT_TRUE(blue) << "the floor";
  MapScene uncut = scene;
  uncut.cut = 100.0;
  EXPECT_NE(renderMap(uncut, 400, 300).rgb, picture.rgb);
}

TEST(MapPicture, SurvivesOddPointsAndEmptyMaps)
{
  MapScene scene = hall();
  const Picture picture = renderMap(scene, 200, 150);
  scene.map.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  EXPECT_EQ(renderMap(scene, 200, 150).rgb, picture.rgb);
  EXPECT_EQ(countPixels(renderMap({}, 32, 32), kWhite), 32U * 32U);
  MapScene point;
  point.map.emplace_back(1.0, 2.0, 3.0);
  EXPECT_LT(countPixels(renderMap(point, 32, 32), kWhite), 32U * 32U);
}

TEST(MapPicture, IsWrittenAsPng)
{
  const TemporaryFolder folder;
  EXPECT_EQ(drawMap(hall(), folder.path() / "map.png"), "");
  EXPECT_EQ(test::contentOf(folder.path() / "map.png").substr(1, 3), "PNG");
  EXPECT_NE(drawMap(MapScene(), folder.path() / "empty.png"), "");
  EXPECT_NE(drawMap(hall(), folder.path() / "nowhere/map.png"), "");
}

}  // namespace pcl_floam::tools
