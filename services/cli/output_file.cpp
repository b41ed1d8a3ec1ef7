#include "cli/output_file.hpp"

#include "crane/configuration/rig.hpp"

namespace crane::cli {

void require_new(const std::filesystem::path& file, bool force) {
  std::error_code ignored;
  if (!force && std::filesystem::exists(std::filesystem::symlink_status(file, ignored)))
    throw configuration::ConfigurationError({file.string() + ": exists; choose another name or --force"});
}

}  // namespace crane::cli
