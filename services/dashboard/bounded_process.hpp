#pragma once
/// A child process of lowest priority that computes for the page. The kernel enforces its limits of time,
/// memory and file size.
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
  /// Kills the process and all its children.
  ~BoundedProcess();
  BoundedProcess(const BoundedProcess&) = delete;
  BoundedProcess& operator=(const BoundedProcess&) = delete;

  struct End {
    int exit_code = -1;  ///< -1: a signal
    std::string how;     ///< "exit code 2", "took longer than 60 s"
  };
  /// Does not wait. @return nothing while the process runs
  [[nodiscard]] std::optional<End> poll();
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  void kill();
  pid_t pid_ = 0;
  Bounds bounds_;
  std::int64_t started_ns_;
};

}  // namespace crane::dashboard
