#include "crane/plant/term.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "crane/plant/coordinates.hpp"

namespace crane::plant {

#define CRANE_TERM(kind) TermKind kind();
#include "terms/registered.def"
#undef CRANE_TERM

namespace {

template <class List, class Text>
std::string listed(const List& entries, Text text) {
  std::string line;
  for (const auto& entry : entries) line += (line.empty() ? "" : ", ") + std::string{text(entry)};
  return line;
}

std::vector<std::string> problems(const TermSetting& setting) {
  const TermKind* kind = find_term(setting.name);
  if (kind == nullptr) {
    return {"no term has this name; must be one of " +
            listed(term_kinds(), [](const TermKind& k) { return k.name; })};
  }
  std::vector<std::string> found;
  if (std::find(kind->axes.begin(), kind->axes.end(), setting.axis) == kind->axes.end()) {
    const auto quoted = [](std::string_view axis) { return '"' + std::string{axis} + '"'; };
    found.push_back("axis = \"" + setting.axis + "\": must be one of " + listed(kind->axes, quoted));
  }
  for (const auto& [name, value] : setting.parameters) {
    const TermParameter* parameter = find_parameter(*kind, name);
    if (parameter != nullptr && value >= parameter->low && value <= parameter->high) continue;
    std::ostringstream line;
    line << name << " = " << value << ": ";
    if (parameter == nullptr)
      line << "the term has no such parameter; must be one of "
           << listed(kind->parameters, [](const TermParameter& p) { return p.name; });
    else
      line << "must be in [" << parameter->low << ", " << parameter->high << "] " << parameter->unit;
    found.push_back(line.str());
  }
  return found;
}

}  // namespace

const std::vector<TermKind>& term_kinds() {
  static const std::vector<TermKind> kKinds{
#define CRANE_TERM(kind) kind(),
#include "terms/registered.def"
#undef CRANE_TERM
  };
  return kKinds;
}

const TermKind* find_term(std::string_view name) {
  const auto& kinds = term_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const TermKind& k) { return k.name == name; });
  return found == kinds.end() ? nullptr : &*found;
}

const TermParameter* find_parameter(const TermKind& kind, std::string_view name) {
  const auto found = std::find_if(kind.parameters.begin(), kind.parameters.end(),
                                  [&](const TermParameter& p) { return p.name == name; });
  return found == kind.parameters.end() ? nullptr : &*found;
}

std::string_view unit_on(std::string_view axis, std::string_view unit) {
  constexpr std::string_view kOr = " or ";
  const std::size_t either = unit.find(kOr);
  if (either == std::string_view::npos || axis.empty()) return unit;
  return axis == kCoordinates[kSlew].axis ? unit.substr(either + kOr.size()) : unit.substr(0, either);
}

std::vector<std::string> problems(const std::vector<TermSetting>& settings) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (const std::string& problem : problems(settings[i])) {
      found.push_back("terms[" + std::to_string(i) + "] " + settings[i].name + ": " + problem);
    }
  }
  return found;
}

std::unique_ptr<Term> make_term(const TermSetting& setting) {
  const std::vector<std::string> found = problems(setting);
  if (!found.empty()) {
    throw std::invalid_argument(setting.name + ": " + listed(found, [](const std::string& s) { return s; }));
  }
  const TermKind& kind = *find_term(setting.name);
  TermSetting complete = setting;
  for (const TermParameter& p : kind.parameters) {
    complete.parameters.emplace(std::string{p.name}, p.default_value);
  }
  return kind.make(complete);
}

Axis drive_axis(std::string_view name) noexcept {
  if (name == kCoordinates[kTrolley].name) return kTrolley;
  return name == kCoordinates[kSlew].name ? kSlew : kHoist;
}

}  // namespace crane::plant
