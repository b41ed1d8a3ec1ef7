#include "crane/boards/linked_rig.hpp"

#include <chrono>
#include <thread>

#include "crane/runtime/process.hpp"

namespace crane::bridge {
namespace {

using runtime::monotonic_ns;
using Role = SharedFile::Role;

constexpr std::int64_t kPatience_ns = 5'000'000'000;
constexpr std::int64_t kSilence_ns = 500'000'000;  // a running rig steps more often than this
// Real time: a rig answers within 0.1 ms, unless the computer pauses its processor. The sum of the waits is
// shorter than the relay timeout (25 ms) minus a period.
constexpr int kLatchWaits = 14;
constexpr std::int64_t kLatchWait_ns = 1'000'000;

/// @return the shared file of a running rig; nothing when no rig runs
std::unique_ptr<SharedFile> find(const std::string& name, SharedLines*& lines) {
  if (!SharedFile::exists(name)) return nullptr;
  auto file = std::make_unique<SharedFile>(name);
  if (file->size() < sizeof(SharedLines)) return nullptr;
  auto* found = static_cast<SharedLines*>(file->map(sizeof(SharedLines)));
  if (found->ready != SharedLines::kReady) return nullptr;
  if (SharedFile probe{name}; probe.take(Role::rig)) return nullptr;  // no process has the role of the rig
  lines = found;
  return file;
}

}  // namespace

LinkedRig::LinkedRig(const std::string& name) {
  const auto deadline_ns = monotonic_ns() + kPatience_ns;
  while (!(file_ = find(name, lines_))) {
    if (monotonic_ns() > deadline_ns || runtime::stop_requested())
      throw BoardError(
          "the emulated rig of this crane does not run: start crane_emulated_rig with the same --crane "
          "and --domain, or use `crane up --plant hardware`");
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  if (!file_->take(Role::bridge))
    throw BoardError("another hardware bridge uses this board: stop it first, or choose another --crane");
}

std::int32_t LinkedRig::pulses(std::size_t channel) noexcept { return lines_->pulses[channel]; }
std::uint16_t LinkedRig::inputs() noexcept { return lines_->inputs; }
std::int64_t LinkedRig::now_ns() noexcept { return lines_->rig_time_ns; }

void LinkedRig::set_converter(std::size_t channel, std::uint16_t code) noexcept {
  if ((lines_->faults & kStuckConverters) != 0) return;
  lines_->codes[channel] = code;
  ++lines_->changes;
}

void LinkedRig::set_outputs(std::uint16_t levels) noexcept {
  if (lines_->outputs.exchange(levels) != levels) {
    const auto at_ns = monotonic_ns();
    auto& change = lines_->output_changes[lines_->output_change_count % SharedLines::kOutputChanges];
    change.at_ns = at_ns;
    change.levels = levels;
    for (std::size_t i = 0; i < kCardChannels; ++i) change.codes[i] = lines_->codes[i].load();
    ++lines_->output_change_count;
    lines_->toggled_ns = at_ns;
  }
  ++lines_->changes;
}

void LinkedRig::advance_to(std::int64_t time_ns) {
  if (!lines_->lockstep) return advance_to_now();
  lines_->until_ns = time_ns;
  ::sem_post(&lines_->advance);
  while (lines_->rig_time_ns < time_ns)
    if (!wait_for(lines_->reached, kPatience_ns))
      throw BoardError("the emulated rig does not answer: look for its message, then start the stack again");
}

/// Advances the rig to the present time: like the counters of a real card, the emulated counters continue to
/// count while the computer pauses. If the rig does not answer, the lines keep their values; require_alive()
/// detects the end of the rig.
void LinkedRig::advance_to_now() {
  const auto now_ns = monotonic_ns();
  lines_->until_ns = now_ns;
  ::sem_post(&lines_->advance);
  for (int i = 0; i < kLatchWaits && lines_->lines_at_ns < now_ns; ++i)
    (void)wait_for(lines_->reached, kLatchWait_ns);
}

void LinkedRig::kick(double radial_radps, double tangential_radps) {
  lines_->kick_radial_radps = radial_radps;
  lines_->kick_tangential_radps = tangential_radps;
  ++lines_->kicks;
}

void LinkedRig::require_alive() {
  if (!lines_->lockstep && monotonic_ns() - lines_->lines_at_ns > kSilence_ns)
    throw BoardError("the emulated rig has stopped: look for its message, then start the stack again");
}

RigMonitor::RigMonitor(const std::string& name) {
  file_ = find(name, lines_);
  if (!file_) throw BoardError("no emulated rig of this crane runs");
}

}  // namespace crane::bridge
