#pragma once
/// Generates the tables of docs/rig_file.md from the tables of fields (rig_fields.hpp).
#include <string>
#include <vector>

namespace crane::configuration {

/// Markdown for one section.
struct SectionTable {
  std::string section;  ///< "plant", "drive", "controller.friction", "rig": the keys outside any table
  std::string markdown;
};
[[nodiscard]] std::vector<SectionTable> section_tables();

/// Replaces each part between "<!-- fields of SECTION -->" and "<!-- end -->" by the generated table.
[[nodiscard]] std::string with_section_tables(const std::string& document);

}  // namespace crane::configuration
