#include <toml++/toml.h>
#include <algorithm>
#include <sstream>

#include "crane/configuration/extended_file.hpp"
#include "crane/fields/shortest.hpp"
#include "section_reader.hpp"

namespace crane::configuration {
namespace {

/// @return the number with a fraction or an exponent; TOML would read any other text as a 64-bit integer
std::string toml_of(double value) {
  const auto text = fields::shortest(value);
  return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}
std::string toml_of(int value) { return std::to_string(value); }
std::string toml_of(bool value) { return value ? "true" : "false"; }
std::string toml_of(const std::string& value) { return toml_string(value); }

/// Writes one field.
template <class Section>
struct FieldWriter {
  std::string& text;
  const Section& section;
  std::string key;

  void line(const std::string& value) const { text += key + " = " + value + '\n'; }

  template <class Value>
  void operator()(Value Section::*member) const {
    line(toml_of(section.*member));
  }
  void operator()(const Element<Section>& element) const {
    line(toml_of((section.*element.array)[element.index]));
  }
  void operator()(const AxisSet<Section>& set) const {
    std::string names;
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      if ((section.*set.member)[i])
        names += (names.empty() ? "" : ", ") + toml_of(std::string{plant::kCoordinates[i].name});
    line('[' + names + ']');
  }
  void operator()(const Choice<Section>& choice) const {
    line(toml_of(choice.names().at(choice.get(section))));
  }
};

/// Texts of the tables, in the order in which the tables are opened.
class Tables {
 public:
  std::string& at(const std::string& path) {
    const auto found = std::find_if(tables_.begin(), tables_.end(),
                                    [&path](const auto& table) { return table.first == path; });
    if (found != tables_.end()) return found->second;
    return tables_.emplace_back(path, path.empty() ? "" : "\n[" + path + "]\n").second;
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const auto& [path, text] : tables_) all += text;
    return all;
  }

 private:
  std::vector<std::pair<std::string, std::string>> tables_;
};

template <class Section, std::size_t N>
void write_section(std::string& text, const std::array<Field<Section>, N>& fields,
                   const std::type_identity_t<Section>& section, std::string_view unit) {
  for (const Field<Section>& field : fields)
    std::visit(FieldWriter<Section>{text, section, key_of(field, unit)}, field.member);
}

std::string terms_text(const std::vector<plant::TermSetting>& terms) {
  std::string text;
  for (const auto& term : terms) {
    text += "\n[[model.terms]]\nname = " + toml_of(term.name) + '\n';
    if (!term.axis.empty()) text += "axis = " + toml_of(term.axis) + '\n';
    for (const auto& [name, value] : term.parameters) text += name + " = " + toml_of(value) + '\n';
  }
  return text;
}

std::string zones_text(const std::vector<control::Zone>& zones) {
  std::string text;
  for (const auto& zone : zones) text += to_toml(zone);
  return text;
}

}  // namespace

std::string toml_string(const std::string& value) {
  std::ostringstream quoted;
  quoted << toml::value<std::string>{value};
  return quoted.str();
}

std::string to_toml(const control::Zone& zone) {
  const bool box = zone.shape == control::ZoneShape::box;
  std::string text = "\n[[zone]]\n";
  for (const auto& field : control::kZoneFields) {
    const bool of_box = field.key == "size_x_m" || field.key == "size_y_m",
               of_cylinder = field.key == "radius_m";
    if ((of_box && !box) || (of_cylinder && box)) continue;
    std::visit(FieldWriter<control::Zone>{text, zone, key_of(field, "")}, field.member);
  }
  return text;
}

std::string to_toml(const Rig& rig) {
  Tables tables;
  for_each_section(
      rig, [&tables](const std::string& path, const auto& fields, const auto& section,
                     std::string_view unit) { write_section(tables.at(path), fields, section, unit); });
  return tables.text() + terms_text(rig.terms) + zones_text(rig.zones);
}

std::uint32_t digest(const Rig& rig, std::string_view controller) {
  constexpr std::uint32_t kOffset = 2166136261, kPrime = 16777619;  // Fowler, Noll, Vo
  std::uint32_t hash = kOffset;
  for (const char c : to_toml(rig) + std::string{controller})
    hash = (hash ^ static_cast<std::uint8_t>(c)) * kPrime;
  return hash == 0 ? 1 : hash;
}

}  // namespace crane::configuration
