#include "registration/repeated_points.h"

#include "common/hash.h"

#include <array>
#include <cstddef>

namespace pcl_floam {

namespace {

using Place = std::array<float, 3>;

Place placeOf(const CloudView& cloud, int number)
{
  const auto n = static_cast<std::size_t>(number);
  return {cloud.x(n) + 0.0F, cloud.y(n) + 0.0F, cloud.z(n) + 0.0F};  // zero has one sign then
}

}  // namespace

std::vector<std::pair<int, int>> dropRepeated(const CloudView& cloud, std::vector<int>& numbers)
{
  unsigned bits = 1;
  while ((std::size_t{1} << bits) < 2 * numbers.size()) {
    ++bits;
  }
  std::vector<int> first(std::size_t{1} << bits, -1);  // of each place
  std::vector<std::pair<int, int>> repeated;
  std::size_t kept = 0;
  for (const int number : numbers) {
    const Place place = placeOf(cloud, number);
    std::size_t i = hashOf(keyOf(place), 64 - bits);
    while (first[i] >= 0 && placeOf(cloud, first[i]) != place) {
      i = (i + 1) & (first.size() - 1);
    }
    if (first[i] >= 0) {
      repeated.emplace_back(number, first[i]);
    } else {
      first[i] = number;
      numbers[kept++] = number;
    }
  }
  numbers.resize(kept);
  return repeated;
}

}  // namespace pcl_floam
