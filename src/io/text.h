/// \file text.h
/// Words and numbers of text files, read alike whatever the program's locale is.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace pcl_floam {

/// The words of a line, separated by blanks, tabs or a carriage return.
[[nodiscard]] inline std::vector<std::string_view> splitWords(std::string_view line)
{
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(kBlanks, begin);
    words.push_back(line.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(kBlanks, end);
  }
  return words;
}

/// The number that a whole word stands for; nothing if it is no number or out of the type's range.
template <typename Number>
[[nodiscard]] std::optional<Number> parseNumber(std::string_view word)
{
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') {
    word.remove_prefix(1);
  }
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) {
    return std::nullopt;
  }
  return number;
}

/// Takes the next line off the front of \p text, without its line end. \p text must not be empty.
[[nodiscard]] inline std::string_view takeLine(std::string_view& text)
{
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

}  // namespace pcl_floam
