#include "crane/configuration/output_files.hpp"

#include "crane/configuration/rig.hpp"
#include "crane/files/complete_file.hpp"

namespace crane::configuration {

void require_other(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs) {
  if (const auto problem = files::overwritten_input(outputs, inputs)) throw ConfigurationError({*problem});
}

}  // namespace crane::configuration
