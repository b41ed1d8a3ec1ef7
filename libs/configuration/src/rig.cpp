#include "crane/configuration/rig.hpp"

#include "crane/configuration/extended_file.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

RigKind read_kind(TomlTable& root) {
  const std::string kind = root.choice("kind", {"tower", "gantry", "drive_axis", "pendulum"});
  if (kind == "gantry") return RigKind::gantry;
  if (kind == "drive_axis") return RigKind::drive_axis;
  if (kind == "pendulum") return RigKind::pendulum;
  return RigKind::tower;
}

}  // namespace

Rig load_rig(const std::filesystem::path& file) { return parse_rig(file_text(file), file.string()); }

Rig parse_rig(const std::string& text, const std::string& file) {
  TomlTable root = with_base(text, file);
  Rig rig;
  rig.path = file;
  rig.name = root.text("name");
  if (root.has("name") && rig.name.empty()) root.problem("name", "must not be empty");
  rig.kind = read_kind(root);
  rig.period_s = root.number("period_s", Range::closed(1e-5, 0.1), rig.period_s);
  rig.board = root.choice("board", {"simulated", "servo_to_go", "comedi", "emulated"}, rig.board);
  read_drives(root, rig);
  read_encoders(root, rig);
  read_wiring(root, rig);
  read_homing(root, rig);
  read_plant(root, rig);
  read_terms(root, rig);
  read_sensing(root, rig);
  read_limits(root, rig);
  read_start(root, rig);
  read_controller(root, rig);
  root.finish();
  return rig;
}

}  // namespace crane::configuration
