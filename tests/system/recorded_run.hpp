#pragma once
/// Converts a recording of real processes to rows for the judge of the fault campaign. Only the recording is
/// used.
#include <filesystem>

#include "campaign/judge/judge.hpp"

namespace crane::system_test {

/// Samples of a recording, by tick.
class Recorded {
 public:
  /// @throws recording::ReadError
  explicit Recorded(const std::filesystem::path& file);
  /// The ticks whose state was sampled within [from_ns, until_ns] of CLOCK_MONOTONIC. Of each topic, the
  /// samples of the first writer from `from_ns` on count; with `nobody_else` the samples of all writers. The
  /// sample times of a foreign writer are copies and prove nothing.
  [[nodiscard]] std::vector<campaign::Row> rows(std::int64_t from_ns, std::int64_t until_ns,
                                                bool nobody_else) const;
  [[nodiscard]] std::size_t states() const { return states_.size(); }

 private:
  template <class T>
  struct Heard {
    std::int64_t log_ns = 0;      ///< arrival at the recorder
    std::int64_t written_ns = 0;  ///< clock of the writer; all processes of a test run on one host
    T sample{};
  };
  /// Tick of the first status that the supervisor has written at this time or later: the first one that can
  /// be the effect of a request of this time.
  [[nodiscard]] std::uint64_t first_tick_after(std::int64_t written_ns) const;
  /// @return nullptr when no state was sampled at this time or later
  [[nodiscard]] const Heard<msg::State>* first_state_from(std::int64_t monotonic_ns) const;

  std::vector<Heard<msg::State>> states_;
  std::vector<Heard<msg::Command>> commands_;
  std::vector<Heard<msg::SupervisorStatus>> statuses_;
  std::vector<Heard<msg::Request>> requests_;
};

}  // namespace crane::system_test
