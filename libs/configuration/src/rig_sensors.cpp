#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

struct EncoderSection {
  std::string_view name, unit;
  bool needed, possible;
};

std::array<EncoderSection, 5> encoder_sections(const Rig& rig) {
  const auto has = [&rig](plant::Axis axis) { return rig.drives[axis].present; };
  const bool swings = rig.kind != RigKind::drive_axis;
  const bool swings_sideways = rig.kind == RigKind::tower || rig.kind == RigKind::pendulum;
  return {{{"trolley", "m", has(plant::kTrolley), has(plant::kTrolley)},
           {"slew", "rad", has(plant::kSlew), has(plant::kSlew)},
           {"hoist", "m", has(plant::kHoist), has(plant::kHoist)},
           {"swing_radial", "rad", swings, swings},
           {"swing_tangential", "rad", rig.kind == RigKind::tower, swings_sideways}}};
}

}  // namespace

void read_encoders(TomlTable& root, Rig& rig) {
  TomlTable encoders = root.required_table("encoder");
  const auto sections = encoder_sections(rig);
  std::vector<int> taken;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const auto& section = sections[i];
    TomlTable table = section.needed ? encoders.required_table(section.name) : encoders.table(section.name);
    if (!table.present()) continue;
    if (!section.possible) table.problem("this rig has no such coordinate to measure");
    Encoder& encoder = rig.encoders[i];
    encoder.channel = table.integer("channel", 0, kLastChannel);
    encoder.counts_per_unit = table.number(with_unit("counts_per", section.unit), Range::above(0, 1e9));
    encoder.sign = read_sign(table);
    check_unique(table, "channel", encoder.channel, taken);
  }
}

void read_sensing(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("sensing");
  Sensing& sensing = rig.sensing;
  sensing.swing_filter_ratio =
      table.number("swing_filter_ratio", {0, 0.5, true, false}, sensing.swing_filter_ratio);
  sensing.filter_swing_angle = table.boolean("filter_swing_angle", sensing.filter_swing_angle);
  if (!table.has("filter_speed")) return;
  sensing.filter_speed.fill(false);
  for (const auto& name : table.texts("filter_speed")) {
    bool found = false;
    for (std::size_t i = 0; i < plant::kAxes; ++i) {
      if (name != kAxisTexts[i].name) continue;
      sensing.filter_speed[i] = found = true;
    }
    if (!found) table.problem("filter_speed", "must name trolley, slew or hoist, not " + name);
  }
}

}  // namespace crane::configuration
