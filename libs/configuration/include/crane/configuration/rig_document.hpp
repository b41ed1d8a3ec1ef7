#pragma once
/// The tables of docs/rig_file.md, made from the tables of fields (rig_fields.hpp).
#include <string>
#include <vector>

namespace crane::configuration {

/// Markdown for one section.
struct SectionTable {
  std::string section;  ///< "plant", "drive", "controller.friction", "rig" for the keys outside a table
  std::string markdown;
};
[[nodiscard]] std::vector<SectionTable> section_tables();

/// The document with each part between "<!-- fields of SECTION -->" and "<!-- end -->" made anew.
[[nodiscard]] std::string with_section_tables(const std::string& document);

}  // namespace crane::configuration
