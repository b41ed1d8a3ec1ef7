#include "crane/boards/linked_rig.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <new>
#include <thread>

#include "crane/bridge/converter.hpp"
#include "crane/runtime/process.hpp"

namespace crane::bridge {
namespace {

using runtime::monotonic_ns;
using Role = SharedFile::Role;

constexpr std::int64_t kPatience_ns = 5'000'000'000;
constexpr std::int64_t kSilence_ns = 500'000'000;  // longer than a rig that runs stays without a step

bool wait_for(sem_t& semaphore, std::int64_t duration_ns) {
  const auto at_ns = monotonic_ns() + duration_ns;
  const timespec at{.tv_sec = at_ns / 1'000'000'000, .tv_nsec = at_ns % 1'000'000'000};
  int result = 0;
  do result = ::sem_clockwait(&semaphore, CLOCK_MONOTONIC, &at);
  while (result != 0 && errno == EINTR);  // a signal ends the process in order, not in the middle of a tick
  return result == 0;
}

/// The file of a rig that runs; nothing while there is none.
std::unique_ptr<SharedFile> find(const std::string& name, SharedLines*& lines) {
  if (!SharedFile::exists(name)) return nullptr;
  auto file = std::make_unique<SharedFile>(name);
  if (file->size() < sizeof(SharedLines)) return nullptr;
  auto* found = static_cast<SharedLines*>(file->map(sizeof(SharedLines)));
  if (found->ready != SharedLines::kReady) return nullptr;
  if (SharedFile probe{name}; probe.take(Role::rig)) return nullptr;  // left behind by a rig that has died
  lines = found;
  return file;
}

}  // namespace

LinkedRig::LinkedRig(const std::string& name) {
  const auto give_up_ns = monotonic_ns() + kPatience_ns;
  while (!(file_ = find(name, lines_))) {
    if (monotonic_ns() > give_up_ns || runtime::stop_requested())
      throw BoardError(
          "the emulated rig of this crane is not there: start crane_emulated_rig with the same --crane "
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
  lines_->codes[channel] = code;
  ++lines_->changes;
}

void LinkedRig::set_outputs(std::uint16_t levels) noexcept {
  if (lines_->outputs.exchange(levels) != levels) {
    const auto at_ns = monotonic_ns();
    auto& change = lines_->output_changes[lines_->output_change_count % SharedLines::kOutputChanges];
    change.at_ns = at_ns;
    change.levels = levels;
    ++lines_->output_change_count;
    lines_->toggled_ns = at_ns;
  }
  ++lines_->changes;
}

void LinkedRig::advance_to(std::int64_t time_ns) {
  if (!lines_->lockstep) return;
  lines_->until_ns = time_ns;
  ::sem_post(&lines_->advance);
  while (lines_->rig_time_ns < time_ns)
    if (!wait_for(lines_->reached, kPatience_ns))
      throw BoardError("the emulated rig does not answer: look for its message, then start the stack again");
}

void LinkedRig::kick(double radial_radps, double tangential_radps) {
  lines_->kick_radial_radps = radial_radps;
  lines_->kick_tangential_radps = tangential_radps;
  ++lines_->kicks;
}

void LinkedRig::require_alive() {
  if (!lines_->lockstep && monotonic_ns() - lines_->beat_ns > kSilence_ns)
    throw BoardError("the emulated rig has stopped: look for its message, then start the stack again");
}

RigMonitor::RigMonitor(const std::string& name) {
  file_ = find(name, lines_);
  if (!file_) throw BoardError("no emulated rig of this crane runs");
}

RigServer::RigServer(const configuration::Rig& rig, const std::string& name, bool lockstep, int model)
    : rig_{rig} {
  for (int i = 0; i < 2 && lines_ == nullptr; ++i) {
    file_ = std::make_unique<SharedFile>(name);
    if (!file_->take(Role::rig))
      throw BoardError(
          "an emulated rig of this crane runs already: stop it first, or choose another --crane");
    if (file_->size() == 0)
      lines_ = new (file_->map(sizeof(SharedLines))) SharedLines{};
    else
      file_->unlink();  // left behind by a rig that has died
  }
  if (lines_ == nullptr) throw BoardError("shared memory " + name + ": in use by something else");
  lines_->lockstep = lockstep;
  lines_->card = rig_.card();
  lines_->card.model = model;
  for (auto& code : lines_->codes) code = kConverterZero;
  ::sem_init(&lines_->advance, 1, 0);
  ::sem_init(&lines_->reached, 1, 0);
  put_lines();
  lines_->ready = SharedLines::kReady;
}

RigServer::~RigServer() { file_->unlink(); }

void RigServer::serve_advance() {
  if (!wait_for(lines_->advance, 50'000'000)) return;
  take_lines();
  seen_output_changes_ = lines_->output_change_count;
  rig_.advance_to(lines_->until_ns);
  put_lines();
  ::sem_post(&lines_->reached);
}

void RigServer::run_to(std::int64_t time_ns) {
  constexpr std::int64_t kStep_ns =
      1'000'000;  // so that a moment is known to the millisecond by a late process too
  const auto offset_ns = monotonic_ns() - time_ns;
  const OutputChange* change = next_output_change();
  while (rig_.now_ns() < time_ns || (change != nullptr && change->at_ns <= time_ns + offset_ns)) {
    const auto change_ns = change != nullptr ? change->at_ns - offset_ns : time_ns;
    const auto now_ns = std::max(rig_.now_ns(), std::min({rig_.now_ns() + kStep_ns, change_ns, time_ns}));
    rig_.advance_to(now_ns);
    note_brakes(now_ns + offset_ns);
    if (change == nullptr || now_ns < change_ns) continue;
    take_converters();
    rig_.set_outputs(change->levels);
    ++seen_output_changes_;
    change = next_output_change();
  }
  if (change == nullptr) take_lines();
  put_lines();
}

/// What this process has not seen yet, though it may be some time ago: a toggle in the meantime kept the
/// relay closed.
const OutputChange* RigServer::next_output_change() {
  const std::uint64_t count = lines_->output_change_count;
  if (seen_output_changes_ == count) return nullptr;
  if (count - seen_output_changes_ >= SharedLines::kOutputChanges)
    seen_output_changes_ = count - SharedLines::kOutputChanges + 1;  // the oldest one may be being replaced
  return &lines_->output_changes[seen_output_changes_ % SharedLines::kOutputChanges];
}

void RigServer::note_brakes(std::int64_t now_ns) {
  const auto state = rig_.crane().read();
  const bool relay = !state.watchdog_dropped;
  const bool brakes = state.brake_closed[0] && state.brake_closed[1] && state.brake_closed[2];
  if (relay_was_closed_ && !relay) lines_->relay_dropped_ns = now_ns;
  if (!brakes_were_closed_ && brakes) lines_->brakes_closed_ns = now_ns;
  relay_was_closed_ = relay;
  brakes_were_closed_ = brakes;
}

void RigServer::take_lines() {
  if (const auto kicks = lines_->kicks.load(); kicks != seen_kicks_) {
    seen_kicks_ = kicks;
    rig_.kick(lines_->kick_radial_radps, lines_->kick_tangential_radps);
  }
  if (lines_->changes == seen_changes_) return;
  take_converters();
  rig_.set_outputs(lines_->outputs);
}

void RigServer::take_converters() {
  seen_changes_ = lines_->changes;
  for (std::size_t i = 0; i < kCardChannels; ++i) rig_.set_converter(i, lines_->codes[i]);
}

void RigServer::put_lines() {
  for (std::size_t i = 0; i < kCardChannels; ++i) lines_->pulses[i] = rig_.pulses(i);
  lines_->inputs = rig_.inputs();
  lines_->beat_ns = monotonic_ns();
  lines_->rig_time_ns = rig_.now_ns();  // last: who waits for a time finds the lines of that time
}

}  // namespace crane::bridge
