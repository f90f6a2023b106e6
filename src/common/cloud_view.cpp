#include <pcl_floam/common/cloud_view.h>

#include "common/field_type.h"

#include <algorithm>
#include <array>
#include <stdexcept>

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

/// Byte offset of a coordinate that must be a float32.
std::uint32_t coordinateOffset(const std::vector<pcl::PCLPointField>& fields, const char* name)
{
  for (const auto& field : fields) {
    if (field.name == name) {
      if (field.datatype != pcl::PCLPointField::FLOAT32) {
        throw std::invalid_argument(std::string("field '") + name + "' of the cloud is not float32");
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
        return {typeOf(field.datatype), field.offset};
      }
    }
  }
  return {};
}

constexpr std::array<std::string_view, 3> kRingNames{"ring", "line", "channel"};
constexpr std::array<std::string_view, 6> kTimeNames{"time",       "t",           "timestamp",
                                                     "time_stamp", "offset_time", "relative_time"};
constexpr std::array<std::string_view, 2> kIntensityNames{"intensity", "reflectivity"};

}  // namespace

double FieldView::read(const std::uint8_t* point) const
{
  double value = 0.0;
  withReader(*this, [&](const auto& reader) { value = reader(point); });
  return value;
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
  describeFields(cloud.fields, view);
  view.data = cloud.data.data();
  view.size = static_cast<std::size_t>(cloud.width) * cloud.height;
  view.stride = cloud.point_step;
  view.width = cloud.width;
  view.height = cloud.height;
  if (view.size > 0 && (view.stride == 0 || cloud.data.size() / view.stride < view.size)) {
    throw std::invalid_argument("the cloud's data is shorter than width x height points");
  }
  return view;
}

}  // namespace pcl_floam
