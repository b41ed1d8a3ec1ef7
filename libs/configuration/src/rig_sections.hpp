#pragma once
/// Readers of the sections of a rig file. Each reader notes its problems in the document (toml_reader.hpp).
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/configuration/toml_reader.hpp"
#include "section_reader.hpp"

namespace crane::configuration {

/// Key of a field, with the unit of the section's coordinate.
template <class Section, std::size_t N>
[[nodiscard]] std::string key_in(const std::array<Field<Section>, N>& fields, std::string_view key,
                                 const plant::Coordinate& coordinate) {
  return key_of(fields::field_of(fields, key), coordinate.unit);
}

/// Reports 0, which the range of integers [-1, 1] permits.
void check_sign(TomlTable& table, int sign);
/// Reports a channel that is in `taken`: two drives on one output, or two encoders on one counter.
void check_unique(TomlTable& table, std::string_view key, int channel, std::vector<int>& taken);
/// Reports a value outside the range. NaN is ignored, because the reader has reported it.
void check_range(TomlTable& table, std::string_view key, double value, const Range& range);

// Plausibility: refuse values that no crane has (rig_plausibility.cpp). The table is that of the section.
void check_plausible_drive(TomlTable& table, const plant::Coordinate& axis, const Drive& drive);
/// @param crane  [plant] or [controller.believes]
void check_plausible_gains(TomlTable& table, const plant::Parameters& crane, const Rig& rig);
void check_plausible_loops(TomlTable& table, const control::Design& design);
void check_plausible_limits(TomlTable& table, const Rig& rig);
void check_repeated_term(TomlTable& table, const std::vector<plant::TermSetting>& earlier,
                         const plant::TermSetting& term);
/// The table of these rules for docs/rig_file.md.
[[nodiscard]] std::string implausible_values();

// Order of the calls: later sections are checked against earlier ones.
void read_drives(TomlTable& root, Rig& rig);
void read_encoders(TomlTable& root, Rig& rig);
void read_wiring(TomlTable& root, Rig& rig);
void read_homing(TomlTable& root, Rig& rig);
void read_plant(TomlTable& root, Rig& rig);
void read_terms(TomlTable& root, Rig& rig);
void read_sensing(TomlTable& root, Rig& rig);
void read_limits(TomlTable& root, Rig& rig);
void read_start(TomlTable& root, Rig& rig);
void read_zones(TomlTable& root, Rig& rig);
void read_controller(TomlTable& root, Rig& rig);
void read_adaptation(TomlTable& root, Rig& rig);

}  // namespace crane::configuration
