#include <pcl_floam/common/core/cloud_view.h>

#include "common/field_type.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_floam {

namespace {

FieldView::Type typeOf(std::uint8_t datatype)
{
  switch (datatype) {
    case pcl::PCLPointField::INT8: return FieldView::Type::int8;
    case pcl::PCLPointField::UINT8: return FieldView::Type::uint8;
    case pcl::PCLPointField::INT16: return FieldView::Type::int16;
    case pcl::PCLPointField::UINT16: return FieldView::Type::uint16;
    case pcl::PCLPointField::INT32: return FieldView::Type::int32;
    case pcl::PCLPointField::UINT32: return FieldView::Type::uint32;
    case pcl::PCLPointField::FLOAT32: return FieldView::Type::float32;
    case pcl::PCLPointField::FLOAT64: return FieldView::Type::float64;
    default: return FieldView::Type::none;
  }
}

std::size_t bytesOf(const FieldView& field)
{
  std::size_t bytes = 0;
  withReader(field, [&bytes](const auto& reader) { bytes = reader.kBytes; });
  return bytes;
}

std::uint32_t coordinateOffset(const std::vector<pcl::PCLPointField>& fields, const char* name)
{
  for (const auto& field : fields) {
    if (field.name == name) {
      if (field.datatype != pcl::PCLPointField::FLOAT32) {
        throw std::invalid_argument(std::string("field '") + name + "' of the cloud is not float32" +
                                    (field.datatype == pcl::PCLPointField::FLOAT64
                                         ? " but float64: makeCoordinatesFloat (cloud_view.h) turns it into that"
                                         : ""));
      }
      return field.offset;
    }
  }
  throw std::invalid_argument(std::string("the cloud has no field '") + name + "'");
}

/// The first of \p names that the cloud has; \p found tells which.
template <std::size_t N>
FieldView findField(const std::vector<pcl::PCLPointField>& fields, const std::array<std::string_view, N>& names,
                    std::string_view* found = nullptr)
{
  for (const std::string_view name : names) {
    for (const auto& field : fields) {
      if (field.name == name) {
        if (found != nullptr) {
          *found = name;
        }
        const FieldView::Type type = typeOf(field.datatype);
        return {type, type == FieldView::Type::none ? 0 : field.offset};
      }
    }
  }
  return {};
}

/// Fields come from a message or a file: one that ends beyond its point would be read from beyond the cloud.
void checkWithinPoint(const char* name, std::uint32_t offset, std::size_t bytes, std::uint32_t point_step)
{
  if (bytes > point_step || offset > point_step - bytes) {
    throw std::invalid_argument(std::string("field '") + name + "' of the cloud, " + std::to_string(bytes) +
                                " bytes at byte " + std::to_string(offset) + ", ends beyond its point of " +
                                std::to_string(point_step) + " bytes (point_step)");
  }
}

void checkFields(const CloudView& view, std::uint32_t point_step)
{
  checkWithinPoint("x", view.x_offset, sizeof(float), point_step);
  checkWithinPoint("y", view.y_offset, sizeof(float), point_step);
  checkWithinPoint("z", view.z_offset, sizeof(float), point_step);
  checkWithinPoint("ring", view.ring.offset, bytesOf(view.ring), point_step);
  checkWithinPoint(std::string(view.time_name).c_str(), view.time.offset, bytesOf(view.time), point_step);
  checkWithinPoint("intensity", view.intensity.offset, bytesOf(view.intensity), point_step);
}

/// A view steps from point to point alike across the ends of rows, and reads numbers as this machine has them.
void checkLayout(const pcl::PCLPointCloud2& cloud)
{
  const std::uint64_t row_bytes = static_cast<std::uint64_t>(cloud.width) * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step != 0 && cloud.row_step != row_bytes) {
    throw std::invalid_argument("the cloud's rows are " + std::to_string(cloud.row_step) +
                                " bytes apart (row_step), but have " + std::to_string(row_bytes) +
                                " bytes of points: take the bytes between them out");
  }
  if (cloud.is_bigendian != 0) {
    throw std::invalid_argument("the cloud's numbers are big-endian: swap their bytes first");
  }
}

void checkSize(const pcl::PCLPointCloud2& cloud)
{
  const std::size_t points = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (points > 0 && (cloud.point_step == 0 || cloud.data.size() / cloud.point_step < points)) {
    throw std::invalid_argument("the cloud's data is shorter than width x height points");
  }
}

/// A float64 as the float32 next to it, which takes the first half of its place.
void narrow(std::uint8_t* bytes)
{
  double wide = 0.0;
  std::memcpy(&wide, bytes, sizeof(wide));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr double kMost = std::numeric_limits<float>::max();
  const float value = std::abs(wide) > kMost ? (wide > 0.0 ? kInfinity : -kInfinity) : static_cast<float>(wide);
  std::memcpy(bytes, &value, sizeof(value));
}

constexpr std::array<std::string_view, 3> kCoordinateNames{"x", "y", "z"};
constexpr std::array<std::string_view, 3> kRingNames{"ring", "line", "channel"};
constexpr std::array<std::string_view, 6> kTimeNames{"time",       "t",           "timestamp",
                                                     "time_stamp", "offset_time", "relative_time"};
constexpr std::array<std::string_view, 2> kIntensityNames{"intensity", "reflectivity"};

}  // namespace

bool isTimeField(std::string_view name)
{
  return std::find(kTimeNames.begin(), kTimeNames.end(), name) != kTimeNames.end();
}

double FieldView::read(const std::uint8_t* point) const
{
  double value = 0.0;
  withReader(*this, [&](const auto& reader) { value = reader(point); });
  return value;
}

float CloudView::intensityOf(std::size_t i) const
{
  const double value = intensity.exists() ? intensity.read(point(i)) : 0.0;
  return std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) ? static_cast<float>(value) : 0.0F;
}

void describeFields(const std::vector<pcl::PCLPointField>& fields, CloudView& view)
{
  view.x_offset = coordinateOffset(fields, "x");
  view.y_offset = coordinateOffset(fields, "y");
  view.z_offset = coordinateOffset(fields, "z");
  view.ring = findField(fields, kRingNames);
  view.time = findField(fields, kTimeNames, &view.time_name);
  view.intensity = findField(fields, kIntensityNames);
}

CloudView viewOf(const pcl::PCLPointCloud2& cloud)
{
  CloudView view;
  checkLayout(cloud);
  describeFields(cloud.fields, view);
  checkFields(view, cloud.point_step);
  view.data = cloud.data.data();
  view.size = static_cast<std::size_t>(cloud.width) * cloud.height;
  view.stride = cloud.point_step;
  view.width = cloud.width;
  view.height = cloud.height;
  checkSize(cloud);
  return view;
}

void makeCoordinatesFloat(pcl::PCLPointCloud2& cloud)
{
  std::vector<pcl::PCLPointField*> wide;
  for (const std::string_view name : kCoordinateNames) {
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [name](const pcl::PCLPointField& candidate) { return candidate.name == name; });
    if (field != cloud.fields.end() && field->datatype == pcl::PCLPointField::FLOAT64) {
      checkWithinPoint(field->name.c_str(), field->offset, sizeof(double), cloud.point_step);
      wide.push_back(&*field);
    }
  }
  if (wide.empty()) {
    return;
  }
  checkLayout(cloud);
  checkSize(cloud);
  const std::size_t points = static_cast<std::size_t>(cloud.width) * cloud.height;
  for (pcl::PCLPointField* field : wide) {
    for (std::size_t i = 0; i < points; ++i) {
      narrow(cloud.data.data() + i * cloud.point_step + field->offset);
    }
    field->datatype = pcl::PCLPointField::FLOAT32;
  }
}

}  // namespace pcl_floam
