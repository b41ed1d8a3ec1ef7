#pragma once
/// Reads a section of a rig file, as its table of fields describes it.
#include <algorithm>

#include "crane/configuration/rig_fields.hpp"
#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

[[nodiscard]] bool is_required(Presence presence, const Rig& rig);
/// Reads an array of names of drives. @param drives  unchanged when the key is absent
void read_axes(TomlTable& table, const std::string& key, std::array<bool, plant::kAxes>& drives);

/// Reads one field. @pre `section` contains the default
template <class Section>
struct FieldReader {
  TomlTable& table;
  const Field<Section>& field;
  Section& section;
  std::string key;
  bool required = false;

  void number(double& value) const {
    if (field.derived != nullptr) value = field.derived(section);
    value = required ? table.number(key, field.range) : table.number(key, field.range, value);
  }
  void operator()(double Section::*member) const { number(section.*member); }
  void operator()(const Element<Section>& element) const { number((section.*element.array)[element.index]); }
  void operator()(int Section::*member) const {
    const int low = static_cast<int>(field.range.low), high = static_cast<int>(field.range.high);
    int& value = section.*member;
    value = required ? table.integer(key, low, high) : table.integer(key, low, high, value);
  }
  void operator()(bool Section::*member) const { section.*member = table.boolean(key, section.*member); }
  void operator()(std::string Section::*member) const {
    section.*member = required ? table.text(key) : table.text(key, section.*member);
  }
  void operator()(const AxisSet<Section>& set) const { read_axes(table, key, section.*set.member); }
  void operator()(const Choice<Section>& choice) const {
    const auto names = choice.names();
    const auto name =
        required ? table.choice(key, names) : table.choice(key, names, names[choice.get(section)]);
    const auto place = std::find(names.begin(), names.end(), name);
    if (place == names.end()) return;  // reported already
    choice.set(section, static_cast<std::size_t>(place - names.begin()));
  }
};

/// Reads the fields in the order of their table. @pre `section` contains the defaults
/// @param rig   determines which fields are required; nullptr: none
/// @param unit  unit of the section's coordinate
template <class Section, std::size_t N>
void read_section(TomlTable& table, const std::array<Field<Section>, N>& fields,
                  std::type_identity_t<Section>& section, const Rig* rig, std::string_view unit = "") {
  for (const Field<Section>& field : fields) {
    const bool required = rig != nullptr && is_required(field.presence, *rig);
    std::visit(FieldReader<Section>{table, field, section, key_of(field, unit), required}, field.member);
  }
}

}  // namespace crane::configuration
