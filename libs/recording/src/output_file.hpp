#pragma once
/// A file that only grows, and is cut back to its last whole part when the disk is full.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace crane::recording {

class OutputFile {
 public:
  /// Creates or truncates. @throws WriteError
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends all of `bytes` or nothing. @throws WriteError, from then on always
  void append(std::string_view bytes);
  /// @throws WriteError
  void sync();
  /// @throws WriteError: some file systems report a full disk only here
  void close();
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// @throws WriteError, the first one again, after a failure
  void require_good() const;

 private:
  [[noreturn]] void fail(std::string_view action);

  std::string name_;
  std::string failure_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace crane::recording
