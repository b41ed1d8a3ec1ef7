#include "stack/started_rig_file.hpp"

#include <fstream>

#include "stack/lockstep_run.hpp"

namespace crane::stack {

void write_started_rig(const std::filesystem::path& file, const configuration::Rig& started) {
  std::ofstream out{file};
  out << "# " << started.name << " as one experiment starts it, from " << started.path << '\n'
      << configuration::to_toml(started);
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

}  // namespace crane::stack
