#include "cli/recording_argument.hpp"

#include <system_error>

#include "crane/recording/parts.hpp"

namespace crane::cli {

CLI::Validator existing_recording() {
  return {[](std::string& name) -> std::string {
            std::error_code ignored;
            if (std::filesystem::is_directory(name, ignored)) return name + ": is a directory";
            if (std::filesystem::exists(recording::files_of(name).front(), ignored)) return {};
            return name + ": no such file, and no parts " + recording::part_file(name, 1).string() + ", ...";
          },
          "RECORDING", "existing recording"};
}

std::vector<std::filesystem::path> existing_files_of(const std::filesystem::path& recording) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::symlink_status(recording, ignored)))
    files.push_back(recording);
  for (const auto& part : recording::parts_of(recording)) files.push_back(part.file);
  return files;
}

}  // namespace crane::cli
