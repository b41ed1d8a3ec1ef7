#include "cli/output_file.hpp"

#include "crane/configuration/rig.hpp"

namespace crane::cli {

void require_new(const std::filesystem::path& file, bool force) {
  std::error_code ignored;
  if (!force && std::filesystem::exists(std::filesystem::symlink_status(file, ignored)))
    throw configuration::ConfigurationError({file.string() + ": exists; choose another name or --force"});
}

void require_other(const std::filesystem::path& file, std::span<const std::filesystem::path> sources) {
  std::error_code ignored;
  for (const auto& source : sources)
    if (std::filesystem::equivalent(source, file, ignored))
      throw configuration::ConfigurationError(
          {file.string() + ": is a file that the command reads; give another name"});
}

}  // namespace crane::cli
