#include "experiments/started_rig_file.hpp"

#include <fstream>

#include "experiments/lockstep_run.hpp"

namespace crane::experiments {

std::string started_rig_text(const configuration::Rig& started) {
  return "# " + started.name + " with the changes of one experiment, from " + started.path + '\n' +
         configuration::to_toml(started);
}

void write_started_rig(const std::filesystem::path& file, const configuration::Rig& started) {
  std::ofstream out{file};
  out << started_rig_text(started);
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

}  // namespace crane::experiments
