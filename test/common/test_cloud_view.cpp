// One view of clouds of every kind.
#include "support/synthetic_cloud.h"

#include <pcl_floam/common/core/cloud_view.h>

#include <pcl/conversions.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace pcl_floam::test {
namespace {

const std::vector<Return> kReturns = {
    {{1.0, 2.0, 3.0}, 4, 0, 0.0}, {{-1.5, 0.25, 9.0}, 65535, 1, 0.5}, {{7.0, -8.0, -0.5}, 200, 2, 1.0}};

TEST(CloudView, SeesTheSameInAPointCloudAndInABlob)
{
  const auto cloud = toCloud(kReturns);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  const CloudView typed = viewOf(cloud);
  const CloudView untyped = viewOf(blob);
  for (const CloudView& view : {typed, untyped}) {
    ASSERT_EQ(view.size, 3U);
    EXPECT_EQ(view.width, 3U);
    EXPECT_EQ(view.height, 1U);
    ASSERT_TRUE(view.ring.exists());
    ASSERT_TRUE(view.time.exists());
    ASSERT_TRUE(view.intensity.exists());
    EXPECT_EQ(view.time_name, "time");
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(view.x(i), cloud[i].x);
      EXPECT_EQ(view.y(i), cloud[i].y);
      EXPECT_EQ(view.z(i), cloud[i].z);
      EXPECT_EQ(view.ring.read(view.point(i)), cloud[i].ring);
      EXPECT_EQ(view.time.read(view.point(i)), cloud[i].time);
      EXPECT_EQ(view.intensity.read(view.point(i)), cloud[i].intensity);
    }
  }
}

template <typename T>
void expectReads(const std::string& name, const std::vector<T>& values, FieldView CloudView::*field)
{
  const auto blob =
      CloudBuilder().field("pad", std::vector<std::uint8_t>(3)).positions(kReturns).field(name, values).build();
  const CloudView view = viewOf(blob);
  ASSERT_TRUE((view.*field).exists()) << name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ((view.*field).read(view.point(i)), static_cast<double>(values[i])) << name;
    EXPECT_EQ(view.y(i), static_cast<float>(kReturns[i].point.y()));
  }
}

TEST(CloudView, ReadsFieldsOfEveryTypeAlignedOrNot)
{
  expectReads<std::int8_t>("ring", {-128, 0, 127}, &CloudView::ring);
  expectReads<std::uint8_t>("ring", {0, 200, 255}, &CloudView::ring);
  expectReads<std::int16_t>("ring", {-3, 0, 32767}, &CloudView::ring);
  expectReads<std::uint16_t>("line", {0, 200, 65535}, &CloudView::ring);
  expectReads<std::int32_t>("channel", {-70000, 0, 70000}, &CloudView::ring);
  expectReads<std::uint32_t>("t", {0, 1, 4294967295U}, &CloudView::time);
  expectReads<float>("offset_time", {0.0F, 0.5F, 1e9F}, &CloudView::time);
  expectReads<double>("timestamp", {1.7e9, 1.7e9 + 1e-6, 0.1}, &CloudView::time);
  expectReads<std::uint16_t>("reflectivity", {1, 2, 3}, &CloudView::intensity);
}

TEST(CloudView, FieldsThatAreNotThereDoNotExist)
{
  const auto cloud = toPositions(kReturns);
  const CloudView view = viewOf(cloud);
  EXPECT_FALSE(view.ring.exists());
  EXPECT_FALSE(view.time.exists());
  EXPECT_FALSE(view.intensity.exists());
}

TEST(CloudView, RefusesACloudWithoutPositions)
{
  const std::vector<float> zeros(3);
  EXPECT_THROW(static_cast<void>(viewOf(CloudBuilder().field("y", zeros).field("z", zeros).build())),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(viewOf(CloudBuilder().field("x", zeros).field("y", zeros).build())),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(viewOf(
                   CloudBuilder().field("x", std::vector<double>(3)).field("y", zeros).field("z", zeros).build())),
               std::invalid_argument);
}

TEST(CloudView, Float64CoordinatesAreMadeFloatInPlace)
{
  const auto make = [](double z) {
    return CloudBuilder()
        .field("pad", std::vector<std::uint8_t>(3))
        .field("z", std::vector<double>{z, 1e300, -1e300})
        .field("x", std::vector<double>{0.1, 5e6 + 0.3, 3.0})
        .field("ring", std::vector<std::uint16_t>{7, 8, 9})
        .field("y", std::vector<float>{1.5F, 2.5F, 3.5F})
        .build();
  };
  auto cloud = make(-2.25);
  makeCoordinatesFloat(cloud);
  const CloudView view = viewOf(cloud);
  EXPECT_EQ(view.x(0), 0.1F);
  EXPECT_EQ(view.x(1), 5000000.5F) << "float32 steps by half a metre there";
  EXPECT_EQ(view.y(2), 3.5F);
  EXPECT_EQ(view.z(0), -2.25F);
  EXPECT_EQ(view.z(1), std::numeric_limits<float>::infinity());
  EXPECT_EQ(view.z(2), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(view.ring.read(view.point(2)), 9.0);

  cloud = make(0.0);
  cloud.fields[2].offset = cloud.point_step - 7;
  EXPECT_THROW(makeCoordinatesFloat(cloud), std::invalid_argument);
  cloud = make(0.0);
  cloud.data.pop_back();
  EXPECT_THROW(makeCoordinatesFloat(cloud), std::invalid_argument);
  cloud = make(0.0);
  cloud.is_bigendian = 1;
  EXPECT_THROW(makeCoordinatesFloat(cloud), std::invalid_argument);
}

TEST(CloudView, RefusesABlobThatIsTooShort)
{
  auto blob = CloudBuilder().positions(kReturns).build();
  blob.data.pop_back();
  EXPECT_THROW(static_cast<void>(viewOf(blob)), std::invalid_argument);
  blob.point_step = 0;
  EXPECT_THROW(static_cast<void>(viewOf(blob)), std::invalid_argument);
}

/// Why a cloud is refused; empty if it is not.
std::string refusal(const pcl::PCLPointCloud2& cloud)
{
  try {
    (void)viewOf(cloud);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CloudView, RefusesFieldsThatReachBeyondThePoint)
{
  const auto good = CloudBuilder()
                        .positions(kReturns)
                        .field("ring", std::vector<std::uint16_t>(3))
                        .field("t", std::vector<double>(3));
  for (const std::string name : {"x", "y", "z", "ring", "t"}) {
    auto blob = good.build();
    ASSERT_EQ(refusal(blob), "");
    for (auto& field : blob.fields) {
      field.offset = field.name == name ? blob.point_step - 1 : field.offset;
    }
    EXPECT_NE(refusal(blob).find("'" + name + "'"), std::string::npos) << refusal(blob);
    for (auto& field : blob.fields) {
      field.offset = field.name == name ? 0xFFFFFFFFU : field.offset;
    }
    EXPECT_NE(refusal(blob).find("'" + name + "'"), std::string::npos) << "offset and size overflow 32 bits";
  }
}

TEST(CloudView, AFieldThatNobodyReadsMayLieAnywhere)
{
  auto blob = CloudBuilder().positions(kReturns).field("label", std::vector<std::uint16_t>(3)).build();
  blob.fields.back().offset = blob.point_step;
  EXPECT_EQ(refusal(blob), "");
}

TEST(CloudView, RefusesRowsThatAreLongerThanTheirPoints)
{
  auto blob = CloudBuilder().positions(kReturns).build();
  blob.width = 1;
  blob.height = 3;
  blob.row_step = blob.point_step;
  EXPECT_EQ(refusal(blob), "");
  blob.row_step = 0;  // many programs leave it out
  EXPECT_EQ(refusal(blob), "");
  blob.row_step = blob.point_step + 4;
  EXPECT_NE(refusal(blob).find("row_step"), std::string::npos);
}

TEST(CloudView, RefusesNumbersOfTheOtherByteOrder)
{
  auto blob = CloudBuilder().positions(kReturns).build();
  blob.is_bigendian = 1;
  EXPECT_NE(refusal(blob).find("big-endian"), std::string::npos);
}

TEST(CloudView, OrganisedShapeIsKept)
{
  pcl::PointCloud<pcl::PointXYZ> cloud(4, 3);
  const CloudView view = viewOf(cloud);
  EXPECT_EQ(view.width, 4U);
  EXPECT_EQ(view.height, 3U);
  EXPECT_EQ(view.size, 12U);
}

}  // namespace
}  // namespace pcl_floam::test
