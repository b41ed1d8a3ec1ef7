#include "experiments/rig_at_start_file.hpp"

#include "crane/files/complete_file.hpp"

namespace crane::experiments {

std::string rig_at_start_text(const configuration::Rig& rig_at_start) {
  return "# " + rig_at_start.name + " with the changes of one experiment, from " + rig_at_start.path + '\n' +
         configuration::to_toml(rig_at_start);
}

void write_rig_at_start(const std::filesystem::path& file, const configuration::Rig& rig_at_start) {
  files::write_file(file, rig_at_start_text(rig_at_start));
}

}  // namespace crane::experiments
