#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

/// True when a rig can measure a coordinate, and when it must.
struct Measurable {
  bool possible, needed;
};

Measurable measurable(const Rig& rig, std::size_t coordinate) {
  if (coordinate < plant::kAxes) return {rig.drives[coordinate].present, rig.drives[coordinate].present};
  if (coordinate == plant::kSwingRadial) return {rig.carries_load(), rig.carries_load()};
  // The load of a gantry swings in one plane. A pendulum can have one or two planes.
  const bool tower = rig.kind == RigKind::tower;
  return {tower || rig.kind == RigKind::pendulum, tower};
}

}  // namespace

void read_encoders(TomlTable& root, Rig& rig) {
  TomlTable encoders = root.required_table("encoder");
  std::vector<int> taken;
  for (std::size_t i = 0; i < plant::kCoordinateCount; ++i) {
    const plant::Coordinate& coordinate = plant::kCoordinates[i];
    const auto [possible, needed] = measurable(rig, i);
    TomlTable table = needed ? encoders.required_table(coordinate.name) : encoders.table(coordinate.name);
    if (!table.present()) continue;
    if (!possible) table.problem("this rig has no such coordinate to measure");
    Encoder& encoder = rig.encoders[i];
    read_section(table, kEncoderFields, encoder, &rig, coordinate.unit);
    if (i >= plant::kAxes) read_section(table, kRestFields, encoder, &rig, "");
    check_sign(table, encoder.sign);
    check_unique(table, "channel", encoder.channel, taken);
  }
}

void read_sensing(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("sensing");
  read_section(table, kSensingFields, rig.sensing, &rig);
}

}  // namespace crane::configuration
