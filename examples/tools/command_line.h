/// \file command_line.h
/// What both tools' command lines have in common: one clear line for a mistake, choices by name, exit statuses.
#pragma once

#include <CLI/CLI.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_floam::tools {

enum ExitStatus : int {
  kExitFine = 0,
  kExitIncomplete = 1,  ///< finished, but a scan or an output is missing
  kExitUsage = 2        ///< bad option or path; nothing was done
};

/// Prints one line to stderr. \return the exit status for it
int reportUsageError(const CLI::App& app, std::string message);

/// Parses the command line. \return the exit status if that is all there is to do (--help, a bad option)
[[nodiscard]] std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv);

/// Help that shows of an option its name, unit, default and description.
void useReadableHelp(CLI::App& app);

/// Checks of numbers. CLI11 by itself takes -1 for a very large count.
[[nodiscard]] CLI::Validator notNegative();
[[nodiscard]] CLI::Validator positive();

template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// An option that takes one of several names. \p value holds the default and must be among the choices.
template <typename Value>
CLI::Option* addChoice(CLI::App& app, const std::string& option, Value& value, const Choices<Value>& choices,
                       const std::string& description)
{
  std::vector<std::string> names;
  std::string list;
  std::string default_name;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    list += (list.empty() ? "" : "|") + name;
    if (choice == value) {
      default_name = name;
    }
  }
  const auto store = [&value, choices](const std::string& given) {
    for (const auto& [name, choice] : choices) {
      if (name == given) {
        value = choice;
      }
    }
  };
  const auto check = [names, list](const std::string& given) {
    const bool known = std::find(names.begin(), names.end(), given) != names.end();
    return known ? std::string() : "must be one of " + list + ", not '" + given + "'";
  };
  return app.add_option_function<std::string>(option, store, description + "\n" + list)
      ->check(CLI::Validator(check, ""))
      ->type_name("NAME")
      ->default_str(default_name);
}

}  // namespace pcl_floam::tools
