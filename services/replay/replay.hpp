#pragma once
/// Replays a recording: the components of the stack receive the recorded samples of clock master
/// and operators, in lockstep, or (recordings of a recorder) with the recorded steps (steps.hpp).
/// Every sample that they publish must equal the recorded one bit for bit. Start-up numbers are not
/// compared in a recording of the recorder, because they are random.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/runtime/wiring.hpp"
#include "replay/difference.hpp"
#include "replay/process_stack.hpp"
#include "replay/recorded_run.hpp"

namespace crane::replay {

struct Difference {
  std::uint64_t tick = 0;
  double time_s = 0;  ///< of the sample of crane/state
  std::string topic;
  FieldDifference what;
};

struct Result {
  bool by_recorder = false;         ///< as RecordedRun::by_recorder()
  std::uint64_t equal_ticks = 0;    ///< ticks from the first on in which every compared sample is equal
  std::optional<Difference> first;  ///< first difference, in the order of the data flow
  std::string ends;                 ///< not empty: why the replay ends after equal_ticks
  std::uint64_t assumed_ticks = 0;  ///< as RecordedRun::assumed_ticks(); part of equal_ticks
  std::uint64_t not_recorded = 0;   ///< compared samples that the recorder did not receive
  /// Ticks in which a process was late; the replay has repeated them (RecordedTick::irregular).
  std::uint64_t irregular_ticks = 0;
  std::uint64_t skipped_ticks = 0;        ///< ticks without a state, because the bridge was late
  std::uint64_t steps_without_state = 0;  ///< of the supervisor
  std::uint64_t decided_by_outputs = 0;   ///< as ReplayedStack::decided_by_outputs()
  /// Damage of the recording; the replay ends before the first damaged tick.
  std::vector<std::string> problems;
  recording::Metadata origin;  ///< metadata of the recording: rig, controller, scenario, version, ...
};

/// The components of every stack except its clock master.
[[nodiscard]] std::vector<runtime::ComponentSpec> loop_components();

/// @param components  replayed components. @throws recording::ReadError, Refusal
[[nodiscard]] Result replay(const std::filesystem::path& file,
                            std::span<const runtime::ComponentSpec> components);
/// As above, with one process for each component over DDS. @throws std::runtime_error when a process ends
[[nodiscard]] Result replay_in_processes(const std::filesystem::path& file, const ProcessOptions& options);

/// "crane/demand of tick 512 (5.12 s): total_v[0]: recorded 1.25, replayed 1.5"
[[nodiscard]] std::string sentence(const Difference& difference);

}  // namespace crane::replay
