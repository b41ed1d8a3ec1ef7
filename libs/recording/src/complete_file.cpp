#include "crane/recording/complete_file.hpp"

#include <algorithm>
#include <system_error>

#include "crane/recording/mcap_writer.hpp"

namespace crane::recording {
namespace {

namespace fs = std::filesystem;

/// The file to replace: `file`, or the target of the symbolic link `file`. @throws WriteError
fs::path replaced_by(const fs::path& file, std::span<const fs::path> sources) {
  std::error_code ignored;
  const auto is_source = [&](const fs::path& source) { return fs::equivalent(source, file, ignored); };
  if (std::ranges::any_of(sources, is_source))
    throw WriteError(file.string() + ": is a file that the command reads; give another name");
  const bool exists = fs::exists(file, ignored);
  if (exists && !fs::is_regular_file(file, ignored))
    throw WriteError(file.string() + ": is no regular file; give another name");
  if (!fs::is_symlink(file, ignored)) return file;
  if (!exists) throw WriteError(file.string() + ": is a link to a missing file; give another name");
  return fs::canonical(file);
}

}  // namespace

CompleteFile::CompleteFile(const fs::path& file, std::span<const fs::path> sources)
    : file_{replaced_by(file, sources)}, partial_{file_.string() + ".partial"} {}

CompleteFile::~CompleteFile() {
  std::error_code ignored;
  if (!published_) fs::remove(partial_, ignored);
}

void CompleteFile::publish() {
  std::error_code failure;
  if (const auto status = fs::status(file_, failure); fs::is_regular_file(status))
    fs::permissions(partial_, status.permissions(), failure);
  fs::rename(partial_, file_, failure);
  if (failure)
    throw WriteError(file_.string() + ": cannot rename " + partial_.string() + ": " + failure.message());
  published_ = true;
}

}  // namespace crane::recording
