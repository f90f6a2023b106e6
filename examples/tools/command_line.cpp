#include "command_line.h"

#include <algorithm>
#include <iostream>
#include <memory>

namespace pcl_floam::tools {

namespace {

/// Of an option, CLI11 also lists what it excludes and needs and how it is checked: more than a reader wants.
class ReadableFormatter : public CLI::Formatter {
public:
  std::string make_option_opts(const CLI::Option* option) const override
  {
    std::string text;
    if (option->get_type_size() > 0) {
      text += " " + option->get_type_name();
    }
    if (!option->get_default_str().empty()) {
      text += " [" + option->get_default_str() + "]";
    }
    return text + (option->get_required() ? " (required)" : "");
  }
};

/// What is no number passes: converting it fails with a message of its own.
template <typename Accept>
CLI::Validator numberCheck(const std::string& demand, const Accept& accept)
{
  const auto check = [demand, accept](const std::string& given) {
    double number = 0.0;
    const bool is_number = CLI::detail::lexical_cast(given, number);
    return !is_number || accept(number) ? std::string() : demand + ", not " + given;
  };
  return {check, ""};
}

}  // namespace

int reportUsageError(const CLI::App& app, std::string message)
{
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << app.get_name() << ": " << message << " (see --help)\n";
  return kExitUsage;
}

std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv)
{
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return app.exit(error);  // --help, --version
    }
    return reportUsageError(app, error.what());
  }
  return std::nullopt;
}

CLI::Validator notNegative()
{
  return numberCheck("must not be negative", [](double number) { return number >= 0.0; });
}

CLI::Validator positive()
{
  return numberCheck("must be greater than 0", [](double number) { return number > 0.0; });
}

void useReadableHelp(CLI::App& app)
{
  constexpr std::size_t kColumn = 34;
  app.formatter(std::make_shared<ReadableFormatter>());
  app.get_formatter()->column_width(kColumn);
}

}  // namespace pcl_floam::tools
