#include "io/natural_order.h"

namespace pcl_floam {

namespace {

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

/// The run of digits at \p begin, without leading zeros.
std::string_view digitsAt(std::string_view text, std::size_t begin, std::size_t& end)
{
  end = begin;
  while (end < text.size() && isDigit(text[end])) {
    ++end;
  }
  while (begin + 1 < end && text[begin] == '0') {
    ++begin;
  }
  return text.substr(begin, end - begin);
}

}  // namespace

bool naturallyBefore(std::string_view a, std::string_view b)
{
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string_view number_a = digitsAt(a, i, i);
      const std::string_view number_b = digitsAt(b, j, j);
      if (number_a != number_b) {
        return number_a.size() != number_b.size() ? number_a.size() < number_b.size() : number_a < number_b;
      }
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  const std::size_t rest_a = a.size() - i;
  const std::size_t rest_b = b.size() - j;
  return rest_a != rest_b ? rest_a < rest_b : a < b;  // equal but for leading zeros: any order, always the same
}

}  // namespace pcl_floam
