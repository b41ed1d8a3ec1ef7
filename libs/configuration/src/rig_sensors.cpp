#include "crane/fields/shortest.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

/// A 24-bit counter shows a larger change in one period as a motion in the opposite direction.
constexpr double kHalfCounterRange_counts = 1 << 23;

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

/// The supervisor and the bridge detect the slip of a closed brake by a change of the position, and the
/// bridge extends a 24-bit counter by the change of its reading in one tick.
void check_resolution(TomlTable& table, const plant::Coordinate& coordinate, const Encoder& encoder,
                      const Drive& drive, double period_s) {
  if (!(encoder.counts_per_unit > 0)) return;  // reported already
  const auto key = key_in(kEncoderFields, "counts_per", coordinate);
  if (const double least = 1 / drive.brake_slip; encoder.counts_per_unit < least)
    table.problem(key, "must be at least " + fields::shortest(least) +
                           ": one count must not exceed the permitted slip of the closed brake, " +
                           fields::shortest(drive.brake_slip) + " " + coordinate.unit);
  if (const double most = kHalfCounterRange_counts / (drive.max_speed * period_s);
      encoder.counts_per_unit >= most)
    table.problem(key, "must be below " + fields::shortest(most) +
                           ": at the largest speed, the counter must change by less than 2^23 counts in one "
                           "period");
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
    if (i < plant::kAxes && possible)
      check_resolution(table, coordinate, encoder, rig.drives[i], rig.period_s);
  }
}

void read_sensing(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("sensing");
  read_section(table, kSensingFields, rig.sensing, &rig);
}

}  // namespace crane::configuration
