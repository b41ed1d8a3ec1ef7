#include "crane/configuration/rig.hpp"

#include <algorithm>
#include <cmath>

#include "crane/configuration/extended_file.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {

int Rig::ticks_in(double time_s) const {
  constexpr double kRounding = 1e-9;
  return std::max(1, static_cast<int>(std::floor(time_s / period_s + kRounding)));
}

Rig load_rig(const std::filesystem::path& file) { return parse_rig(file_text(file), file.string()); }

Rig parse_rig(const std::string& text, const std::string& file) {
  TomlTable root = with_base(text, file);
  Rig rig;
  rig.path = file;
  read_section(root, kRigFields, rig, &rig);
  if (root.has("name") && rig.name.empty()) root.problem("name", "must not be empty");
  read_drives(root, rig);
  read_encoders(root, rig);
  read_wiring(root, rig);
  read_homing(root, rig);
  read_plant(root, rig);
  read_terms(root, rig);
  read_sensing(root, rig);
  read_limits(root, rig);
  read_start(root, rig);
  read_zones(root, rig);
  read_controller(root, rig);
  read_adaptation(root, rig);
  root.finish();
  return rig;
}

}  // namespace crane::configuration
