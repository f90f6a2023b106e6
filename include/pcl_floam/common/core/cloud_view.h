/// \file cloud_view.h
/// One scan of any point type, seen without copying it and without templates.
#pragma once

#include <pcl/for_each_type.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam {

/// Where in a point's bytes a field lies, and its type.
struct FieldView {
  enum class Type : std::uint8_t { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

  Type type = Type::none;
  std::uint32_t offset = 0;  ///< bytes from the start of the point

  [[nodiscard]] bool exists() const { return type != Type::none; }

  /// The field's value in the point that starts at \p point. The field must exist.
  [[nodiscard]] double read(const std::uint8_t* point) const;
};

/// A read-only view of a cloud's memory, of whatever point type.
///
/// This is what the compiled core works on: one way in for `pcl::PointCloud` of every point type and for
/// `pcl::PCLPointCloud2`. It owns nothing: the cloud must outlive it.
struct CloudView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;    ///< number of points
  std::size_t stride = 0;  ///< bytes from one point to the next
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t x_offset = 0;  ///< x, y and z are float32
  std::uint32_t y_offset = 0;
  std::uint32_t z_offset = 0;
  FieldView ring;              ///< field `ring`, `line` or `channel`
  FieldView time;              ///< field `time`, `t`, `timestamp`, `time_stamp`, `offset_time` or `relative_time`
  FieldView intensity;         ///< field `intensity` or `reflectivity`
  std::string_view time_name;  ///< which of the names it is; tells the likely unit

  [[nodiscard]] const std::uint8_t* point(std::size_t i) const { return data + i * stride; }
  [[nodiscard]] float x(std::size_t i) const { return readFloat(point(i) + x_offset); }
  [[nodiscard]] float y(std::size_t i) const { return readFloat(point(i) + y_offset); }
  [[nodiscard]] float z(std::size_t i) const { return readFloat(point(i) + z_offset); }
  /// 0 without the field, or where it is no number that float32 can hold.
  [[nodiscard]] float intensityOf(std::size_t i) const;

  static float readFloat(const std::uint8_t* bytes)
  {
    float value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  }
};

/// Whether a field of that name holds the points' times.
[[nodiscard]] bool isTimeField(std::string_view name);

/// Fills the field offsets of \p view from PCL's list of fields.
/// \throws std::invalid_argument if x, y or z is missing or not float32.
void describeFields(const std::vector<pcl::PCLPointField>& fields, CloudView& view);

/// Lists the fields of a point type, one at each call. `pcl::getFields` does the same, and would bring all of
/// pcl/common/io.h along.
template <typename PointT>
struct FieldLister {
  std::vector<pcl::PCLPointField>& fields;

  template <typename Tag>
  void operator()() const
  {
    pcl::PCLPointField field;
    field.name = pcl::traits::name<PointT, Tag>::value;
    field.offset = pcl::traits::offset<PointT, Tag>::value;
    field.datatype = pcl::traits::datatype<PointT, Tag>::value;
    field.count = pcl::traits::datatype<PointT, Tag>::size;
    fields.push_back(field);
  }
};

/// The view of a cloud of any PCL point type with x, y, z.
template <typename PointT>
[[nodiscard]] CloudView viewOf(const pcl::PointCloud<PointT>& cloud)
{
  CloudView view;
  std::vector<pcl::PCLPointField> fields;
  pcl::for_each_type<typename pcl::traits::fieldList<PointT>::type>(FieldLister<PointT>{fields});
  describeFields(fields, view);
  view.data = reinterpret_cast<const std::uint8_t*>(cloud.points.data());
  view.size = cloud.points.size();
  view.stride = sizeof(PointT);
  view.width = cloud.width;
  view.height = cloud.height;
  return view;
}

/// The view of a cloud whose point type is known only at run time.
/// \throws std::invalid_argument if x, y or z is missing or not float32 (see makeCoordinatesFloat), a field that is
/// read ends beyond its point, the blob is shorter than its width times height points, its rows have bytes between them
/// (row_step), or its numbers are big-endian.
[[nodiscard]] CloudView viewOf(const pcl::PCLPointCloud2& cloud);

/// Makes x, y, z that are float64 float32, in place: the points keep their size and all other fields. Far from the
/// origin that costs precision (at 5e6 m, as in UTM coordinates, float32 steps by 0.5 m): subtract an offset before.
/// Numbers that float32 cannot hold become infinite, which is no measured point.
/// \throws std::invalid_argument as \ref viewOf, with the cloud left as it was.
void makeCoordinatesFloat(pcl::PCLPointCloud2& cloud);

}  // namespace pcl_floam
