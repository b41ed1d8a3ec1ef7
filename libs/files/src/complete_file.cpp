#include "crane/files/complete_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

namespace crane::files {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int reason) {
  throw WriteError(file.string() + ": cannot write: " + std::generic_category().message(reason));
}

/// The file to replace: `file`, or the target of the symbolic link `file`. @throws WriteError
fs::path replaced_by(const fs::path& file, std::span<const fs::path> sources) {
  if (const auto problem = overwritten_input(std::span{&file, 1}, sources)) throw WriteError(*problem);
  std::error_code ignored;
  const bool exists = fs::exists(file, ignored);
  if (exists && !fs::is_regular_file(file, ignored))
    throw WriteError(file.string() + ": is no regular file; give another name");
  // rename() would also replace a file that its owner has protected
  if (exists && ::access(file.c_str(), W_OK) != 0) fail(file, errno);
  if (!fs::is_symlink(file, ignored)) return file;
  if (!exists) throw WriteError(file.string() + ": is a link to a missing file; give another name");
  return fs::canonical(file);
}

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> index{0, kLetters.size() - 1};
  std::array<char, 6> letters{};
  for (char& letter : letters) letter = kLetters[index(device)];
  return {letters.begin(), letters.end()};
}

/// Creates a file with a new name beside `file`. mkostemps() would give it the permissions 0600; open()
/// applies the umask of the user. @throws WriteError that names `file`
fs::path new_partial(const fs::path& file) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const fs::path partial = file.string() + "." + random_letters() + ".partial";
    const int descriptor = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return partial;
    }
    if (errno != EEXIST) break;
  }
  fail(file, errno);
}

/// @param target  file that `out` receives; @param named  name for an error
void write_to(const fs::path& target, const fs::path& named,
              const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream out{target, std::ios::binary};
  if (out) write(out);
  out.close();
  if (!out) fail(named, errno);
}

}  // namespace

std::optional<std::string> overwritten_input(std::span<const fs::path> outputs,
                                             std::span<const fs::path> inputs) {
  std::error_code ignored;
  for (const auto& output : outputs)
    for (const auto& input : inputs)
      if (fs::equivalent(input, output, ignored))
        return output.string() + ": is a file that the command reads; give another name";
  return std::nullopt;
}

CompleteFile::CompleteFile(const fs::path& file, std::span<const fs::path> sources)
    : file_{replaced_by(file, sources)}, partial_{new_partial(file_)} {}

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

void write_file(const fs::path& file, const std::function<void(std::ostream&)>& write,
                std::span<const fs::path> sources) {
  std::error_code ignored;
  if (fs::is_other(file, ignored)) return write_to(file, file, write);
  CompleteFile complete{file, sources};
  write_to(complete.partial(), file, write);
  complete.publish();
}

void require_writable(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_other(file, ignored)) const CompleteFile removed_again{file};
}

void write_file(const fs::path& file, std::string_view text) {
  write_file(file, [text](std::ostream& out) { out << text; });
}

}  // namespace crane::files
