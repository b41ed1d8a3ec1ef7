#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

/// Reports a line or a subdevice that has two signals.
template <class Section, std::size_t N>
void check_lines(TomlTable& table, const std::array<Field<Section>, N>& fields, const Section& section,
                 std::string_view ending, std::vector<int>& taken) {
  for (const auto& field : fields)
    if (const auto* member = std::get_if<int Section::*>(&field.member);
        member && field.key.ends_with(ending))
      check_unique(table, field.key, section.**member, taken);
}

void check_address(TomlTable& table, int address) {
  constexpr int kAddressStep = 0x20;
  if (address % kAddressStep != 0)
    table.problem("base_address", "must be 0x200 + 0x20 n, as the board's jumpers are set");
}

}  // namespace

void read_wiring(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("wiring");
  read_section(table, kWiringFields, rig.wiring, &rig);
  check_address(table, rig.wiring.base_address);
  std::vector<int> subdevices, lines;
  check_lines(table, kWiringFields, rig.wiring, "_subdevice", subdevices);
  check_lines(table, kWiringFields, rig.wiring, "estop_input", lines);
  check_lines(table, kWiringFields, rig.wiring, "relay_closed_input", lines);
  check_lines(table, kWiringFields, rig.wiring, "_output", lines);
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (!rig.drives[i].present) continue;
    TomlTable drive = table.table(plant::kCoordinates[i].name);
    read_section(drive, kDriveLineFields, rig.wiring.drives[i], &rig);
    check_lines(drive, kDriveLineFields, rig.wiring.drives[i], "", lines);
  }
}

}  // namespace crane::configuration
