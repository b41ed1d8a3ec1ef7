#include "crane/configuration/rig.hpp"
#include "crane/fields/printable.hpp"

namespace crane::configuration {
namespace {

std::string one_a_line(const std::vector<std::string>& problems) {
  std::string text;
  for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  return text;
}

/// Makes the text printable, because keys and values of a file may contain any character.
std::vector<std::string> printable(std::vector<std::string> problems) {
  for (auto& problem : problems) fields::make_printable(problem);
  return problems;
}

}  // namespace

ConfigurationError::ConfigurationError(std::vector<std::string> problems)
    : std::runtime_error(one_a_line(printable(problems))), problems_(printable(std::move(problems))) {}

}  // namespace crane::configuration
