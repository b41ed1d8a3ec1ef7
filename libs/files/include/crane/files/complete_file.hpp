#pragma once
/// A file that appears, or replaces an existing file, only when it is complete.
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace crane::files {

/// A file cannot be written. what() names file and reason: "run.csv: cannot write: No space left on device".
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @return the problem, for the first of `outputs` that is one of `inputs`, also under another name (links);
/// nothing when all files differ
[[nodiscard]] std::optional<std::string> overwritten_input(std::span<const std::filesystem::path> outputs,
                                                           std::span<const std::filesystem::path> inputs);

class CompleteFile {
 public:
  /// Creates an empty file FILE.XXXXXX.partial, which the caller writes. The name is new: no existing file is
  /// replaced. If `file` is a symbolic link, its target is replaced.
  /// @param sources  files that are read while `file` is written
  /// @throws WriteError when `file` exists and is no regular file, is one of `sources`, or is a link to a
  /// missing file; when its directory cannot be written
  explicit CompleteFile(const std::filesystem::path& file,
                        std::span<const std::filesystem::path> sources = {});
  /// Removes the partial file, unless publish() was called.
  ~CompleteFile();
  CompleteFile(const CompleteFile&) = delete;
  CompleteFile& operator=(const CompleteFile&) = delete;

  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
  /// Gives the partial file the permissions of the replaced file and renames it to FILE. @throws WriteError
  void publish();

 private:
  std::filesystem::path file_, partial_;
  bool published_ = false;
};

/// Tests that `file` can be written, without changing it. Call it before long work whose result is written to
/// `file`. @throws WriteError in the same cases as CompleteFile
void require_writable(const std::filesystem::path& file);

/// Writes `file` completely, or leaves it as it was. Devices and pipes receive the bytes directly.
/// @throws WriteError, as CompleteFile; exceptions of `write`
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream& out)>& write,
                std::span<const std::filesystem::path> sources = {});
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace crane::files
