#pragma once
/// One reader per section of a rig file; each notes its problems in the document (toml_reader.hpp).
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/configuration/toml_reader.hpp"
#include "section_reader.hpp"

namespace crane::configuration {

/// The key of a field, with the unit of the coordinate that its section is about.
template <class Section, std::size_t N>
[[nodiscard]] std::string key_in(const std::array<Field<Section>, N>& fields, std::string_view key,
                                 const plant::Coordinate& coordinate) {
  return key_of(fields::field_of(fields, key), coordinate.unit);
}

/// +1 or -1 is asked for; the range of integers lets 0 pass.
void check_sign(TomlTable& table, int sign);
/// Two drives on one output, or two encoders on one counter, are a wiring mistake.
void check_unique(TomlTable& table, std::string_view key, int channel, std::vector<int>& taken);
/// Notes a problem of `key` where the value is no NaN, which has been reported, and outside the range.
void check_range(TomlTable& table, std::string_view key, double value, const Range& range);

// In the order in which they are called: later sections are checked against the earlier ones.
void read_drives(TomlTable& root, Rig& rig);
void read_encoders(TomlTable& root, Rig& rig);
void read_wiring(TomlTable& root, Rig& rig);
void read_homing(TomlTable& root, Rig& rig);
void read_plant(TomlTable& root, Rig& rig);
void read_terms(TomlTable& root, Rig& rig);
void read_sensing(TomlTable& root, Rig& rig);
void read_limits(TomlTable& root, Rig& rig);
void read_start(TomlTable& root, Rig& rig);
void read_controller(TomlTable& root, Rig& rig);

}  // namespace crane::configuration
