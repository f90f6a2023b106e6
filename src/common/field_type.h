/// \file field_type.h
/// A field's type, found once for a whole cloud instead of once per point.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>

#include <cstdint>
#include <cstring>

namespace pcl_floam {

/// Reads one field of type \p T from point after point.
template <typename T>
struct FieldReader {
  static constexpr std::size_t kBytes = sizeof(T);
  std::uint32_t offset;

  double operator()(const std::uint8_t* point) const
  {
    T value;
    std::memcpy(&value, point + offset, sizeof(value));
    return static_cast<double>(value);
  }
};

/// Calls \p work with the reader for a field, which must exist.
template <typename Work>
void withReader(const FieldView& field, Work&& work)
{
  using Type = FieldView::Type;
  switch (field.type) {
    case Type::int8: return work(FieldReader<std::int8_t>{field.offset});
    case Type::uint8: return work(FieldReader<std::uint8_t>{field.offset});
    case Type::int16: return work(FieldReader<std::int16_t>{field.offset});
    case Type::uint16: return work(FieldReader<std::uint16_t>{field.offset});
    case Type::int32: return work(FieldReader<std::int32_t>{field.offset});
    case Type::uint32: return work(FieldReader<std::uint32_t>{field.offset});
    case Type::float32: return work(FieldReader<float>{field.offset});
    case Type::float64: return work(FieldReader<double>{field.offset});
    case Type::none: return;
  }
}

}  // namespace pcl_floam
