#include "experiments/started_rig_file.hpp"

#include "crane/files/complete_file.hpp"

namespace crane::experiments {

std::string started_rig_text(const configuration::Rig& started) {
  return "# " + started.name + " with the changes of one experiment, from " + started.path + '\n' +
         configuration::to_toml(started);
}

void write_started_rig(const std::filesystem::path& file, const configuration::Rig& started) {
  files::write_file(file, started_rig_text(started));
}

}  // namespace crane::experiments
