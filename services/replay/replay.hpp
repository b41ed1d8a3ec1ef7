#pragma once
/// Replays a recording in lockstep: the components of the stack receive the recorded samples of clock master
/// and operators, and everything they publish must equal the recording, bit for bit.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/runtime/wiring.hpp"
#include "replay/difference.hpp"
#include "replay/recorded_run.hpp"

namespace crane::replay {

struct Difference {
  std::uint64_t tick = 0;
  double time_s = 0;  ///< of the sample of crane/state
  std::string topic;
  FieldDifference what;
};

struct Result {
  std::uint64_t equal_ticks = 0;    ///< ticks from 0 on in which every compared sample is equal
  std::optional<Difference> first;  ///< first difference, in the order of the data flow
  std::vector<std::string>
      problems;                /// damage of the recording; the replay ends before the first damaged tick
  recording::Metadata origin;  ///< of the recording: rig, controller, scenario, version ...
};

/// The components of every stack behind its clock master.
[[nodiscard]] std::vector<runtime::ComponentSpec> loop_components();

/// @param components  replayed components. @throws recording::ReadError, Refusal
[[nodiscard]] Result replay(const std::filesystem::path& file,
                            std::span<const runtime::ComponentSpec> components);

/// "crane/demand of tick 512 (5.12 s): total_v[0]: recorded 1.25, replayed 1.5"
[[nodiscard]] std::string sentence(const Difference& difference);

}  // namespace crane::replay
