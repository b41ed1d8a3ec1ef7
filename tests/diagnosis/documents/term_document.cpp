#include "documents/term_document.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <regex>

#include "crane/plant/term.hpp"

namespace crane::test {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string acts_on_text(plant::ActsOn acts_on) {
  constexpr std::array kTexts{"parameters", "command", "drive", "load", "structure", "sensor"};
  return kTexts.at(static_cast<std::size_t>(acts_on));
}

std::string axes_text(const plant::TermKind& kind) {
  std::string text;
  for (const std::string_view axis : kind.axes)
    text += (text.empty() ? "" : ", ") + (axis.empty() ? std::string{"none"} : std::string{axis});
  return text;
}

std::string summary(const plant::TermKind& kind, bool candidate, bool of_twin) {
  const auto yes_or_no = [](bool value) { return value ? "yes" : "no"; };
  const std::string name{kind.name};
  return "| [`" + name + "`](#" + name + ") | " + acts_on_text(kind.acts_on) + " | " + axes_text(kind) +
         " | " + yes_or_no(candidate) + " | " + yes_or_no(of_twin) + " |\n";
}

std::string parameter_row(const plant::TermParameter& parameter) {
  return "| `" + std::string{parameter.name} + "` | " + std::string{parameter.unit} + " | [" +
         number(parameter.low) + ", " + number(parameter.high) + "] | " + number(parameter.default_value) +
         " | " + std::string{parameter.meaning} + " |\n";
}

std::string rig_file_entry(const plant::TermSetting& setting) {
  std::string text = "```toml\n[[model.terms]]\nname = \"" + setting.name + "\"\n";
  if (!setting.axis.empty()) text += "axis = \"" + setting.axis + "\"\n";
  for (const auto& [name, value] : setting.parameters) text += name + " = " + number(value) + '\n';
  return text + "```\n";
}

/// Description, equation, parameters and example of one term.
std::string section(const plant::TermKind& kind) {
  const std::string clauses = std::regex_replace(std::string{kind.equation}, std::regex{"; "}, "\n");
  std::string effect{kind.effect};
  effect.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(effect.front())));
  std::string text = "\n## " + std::string{kind.name} + '\n' + effect + ".\n```\n" + clauses +
                     "\n```\n\n| parameter | unit | range | default | meaning |\n|---|---|---|---|---|\n";
  for (const plant::TermParameter& parameter : kind.parameters) text += parameter_row(parameter);
  return text + '\n' + rig_file_entry(kind.example);
}

}  // namespace

std::string term_list(const std::set<std::string>& candidates, const std::set<std::string>& causes_of_twin) {
  std::string table =
      "| term | acts on | axes | candidate of `crane diagnose` | cause of the twin "
      "|\n|---|---|---|---|---|\n";
  std::string sections;
  for (const plant::TermKind& kind : plant::term_kinds()) {
    const std::string name{kind.name};
    table += summary(kind, candidates.contains(name), causes_of_twin.contains(name));
    sections += section(kind);
  }
  return table + sections;
}

}  // namespace crane::test
