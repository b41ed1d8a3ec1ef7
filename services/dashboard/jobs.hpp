#pragma once
/// Reviews and diagnoses that the page has requested. Each job is a child process with limits; one job runs
/// at a time.
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dashboard/bounded_process.hpp"
#include "dashboard/runs.hpp"

namespace crane::dashboard {

class Jobs {
 public:
  enum class State : std::uint8_t { waiting, running, done, failed, cancelled };
  static constexpr std::size_t kMostWaiting = 8;
  static constexpr std::size_t kMostKept = 24;  ///< jobs including ended ones; the oldest are deleted
  static constexpr Bounds kReview{std::chrono::seconds{60}, 2ULL << 30U, 64ULL << 20U};
  static constexpr Bounds kDiagnosis{std::chrono::seconds{1200}, 4ULL << 30U, 64ULL << 20U};

  /// @param program  `crane`  @param rig  rig file of a diagnosis; empty: no diagnosis is possible
  /// @param directory  exists; used by this object only
  Jobs(std::filesystem::path program, std::string rig, std::filesystem::path directory);

  struct Answer {
    std::uint64_t id = 0;
    std::string problem;  ///< empty: the job waits, runs or is done
    bool busy = false;    ///< true: the problem is temporary
  };
  [[nodiscard]] Answer review(const Run& run);
  [[nodiscard]] Answer diagnose(const std::vector<Run>& train, const std::vector<Run>& test);
  /// @return false when the job with this number neither waits nor runs
  bool cancel(std::uint64_t id);

  /// Starts waiting jobs and collects finished ones. Does not wait.
  void poll();
  [[nodiscard]] nlohmann::ordered_json json() const;
  /// A file of a finished job; nothing when it does not exist. @param name  "report.html", "result.json"
  [[nodiscard]] std::optional<std::string> file_of(std::uint64_t id, const char* name) const;

 private:
  struct Job {
    std::uint64_t id = 0;
    const char* kind = "";
    std::string key;  ///< equal for reviews of the same file, which share one job
    std::vector<std::string> runs, arguments;
    Bounds bounds;
    State state = State::waiting;
    std::int64_t begun_ns = 0, ended_ns = 0;
    std::string problem{};
  };
  Answer add(Job job);
  [[nodiscard]] std::filesystem::path directory_of(std::uint64_t id) const;
  void start(Job& job);
  void finish(Job& job, const BoundedProcess::End& end);
  [[nodiscard]] nlohmann::ordered_json json_of(const Job& job) const;
  [[nodiscard]] std::string errors_of(std::uint64_t id) const;

  std::filesystem::path program_;
  std::string rig_;
  std::filesystem::path directory_;
  std::deque<Job> jobs_;
  std::unique_ptr<BoundedProcess> running_;
  std::uint64_t running_id_ = 0, next_id_ = 1;
};

}  // namespace crane::dashboard
