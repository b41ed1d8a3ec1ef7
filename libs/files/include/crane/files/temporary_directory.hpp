#pragma once
#include <filesystem>
#include <string>

namespace crane::files {

/// A new directory among the temporary files, which only this user can read; deleted with this object. Its
/// name cannot be foreseen: no other user can put a link in the place of its files.
class TemporaryDirectory {
 public:
  /// @param name  begin of the name: "crane_replay" @throws WriteError
  explicit TemporaryDirectory(const std::string& name);
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace crane::files
