#include "crane/files/temporary_directory.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "crane/files/complete_file.hpp"

namespace crane::files {

TemporaryDirectory::TemporaryDirectory(const std::string& name) {
  auto pattern = (std::filesystem::temp_directory_path() / (name + "_XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw WriteError(pattern + ": cannot be made: " + std::generic_category().message(errno));
  path_ = pattern;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace crane::files
