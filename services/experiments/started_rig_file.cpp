#include "experiments/started_rig_file.hpp"

#include <fstream>

#include "experiments/lockstep_run.hpp"

namespace crane::experiments {

void write_started_rig(const std::filesystem::path& file, const configuration::Rig& started) {
  std::ofstream out{file};
  out << "# " << started.name << " with the changes of one experiment, from " << started.path << '\n'
      << configuration::to_toml(started);
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

}  // namespace crane::experiments
