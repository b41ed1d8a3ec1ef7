#pragma once
/// A program that computes something for the page, with bounds that the kernel keeps, behind every other
/// process of this computer.
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crane::dashboard {

struct Bounds {
  std::chrono::seconds time;   ///< wall clock, and processor time of each processor
  std::uint64_t memory_bytes;  ///< address space
  std::uint64_t largest_file_bytes;
};

class BoundedProcess {
 public:
  /// Starts `program`; its standard output and error become files. @throws std::runtime_error
  BoundedProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& output, const std::filesystem::path& errors,
                 const Bounds& bounds);
  /// Kills it with all that it has started.
  ~BoundedProcess();
  BoundedProcess(const BoundedProcess&) = delete;
  BoundedProcess& operator=(const BoundedProcess&) = delete;

  struct End {
    int exit_code = -1;  ///< -1: a signal
    std::string how;     ///< "exit code 2", "took longer than 60 s"
  };
  /// Does not wait. @return nothing while it runs
  [[nodiscard]] std::optional<End> poll();
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  void kill();
  pid_t pid_ = 0;
  Bounds bounds_;
  std::int64_t started_ns_;
};

}  // namespace crane::dashboard
