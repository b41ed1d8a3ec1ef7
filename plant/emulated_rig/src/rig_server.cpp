#include "crane/emulated_rig/rig_server.hpp"

#include <algorithm>
#include <new>

#include "crane/bridge/converter.hpp"
#include "crane/runtime/process.hpp"

namespace crane::emulated_rig {

using runtime::monotonic_ns;

RigServer::RigServer(const configuration::Rig& rig, const std::string& name, bool lockstep, int model)
    : rig_{rig} {
  for (int i = 0; i < 2 && lines_ == nullptr; ++i) {
    file_ = std::make_unique<bridge::SharedFile>(name);
    if (!file_->take(bridge::SharedFile::Role::rig))
      throw bridge::BoardError(
          "an emulated rig of this crane runs already: stop it first, or choose another --crane");
    if (file_->size() == 0)
      lines_ = new (file_->map(sizeof(bridge::SharedLines))) bridge::SharedLines{};
    else
      file_->unlink();  // the file of a rig that has ended
  }
  if (lines_ == nullptr) throw bridge::BoardError("shared memory " + name + ": in use by something else");
  lines_->lockstep = lockstep;
  lines_->card = rig_.card();
  lines_->card.model = model;
  for (auto& code : lines_->codes) code = bridge::kConverterZero;
  ::sem_init(&lines_->advance, 1, 0);
  ::sem_init(&lines_->reached, 1, 0);
  put_lines(monotonic_ns());
  lines_->ready = bridge::SharedLines::kReady;
}

RigServer::~RigServer() { file_->unlink(); }

void RigServer::serve_advance() {
  if (!bridge::wait_for(lines_->advance, 50'000'000)) return;
  take_lines();
  seen_output_changes_ = lines_->output_change_count;
  rig_.advance_to(lines_->until_ns);
  put_lines(monotonic_ns());
  ::sem_post(&lines_->reached);
}

bool RigServer::serve_realtime(std::int64_t begin_ns, std::int64_t wake_ns) {
  const bool requested = bridge::wait_for(lines_->advance, wake_ns - monotonic_ns());
  const auto at_ns = requested ? lines_->until_ns.load() : monotonic_ns();
  run_to(at_ns - begin_ns, at_ns);
  if (requested) ::sem_post(&lines_->reached);
  return requested;
}

void RigServer::run_to(std::int64_t time_ns, std::int64_t at_ns) {
  // a late process still applies each event within 1 ms of its time
  constexpr std::int64_t kStep_ns = 1'000'000;
  const auto offset_ns = at_ns - time_ns;
  const bridge::OutputChange* change = next_output_change();
  rig_.inject(lines_->faults);
  while (rig_.now_ns() < time_ns || (change != nullptr && change->at_ns <= time_ns + offset_ns)) {
    const auto change_ns = change != nullptr ? change->at_ns - offset_ns : time_ns;
    const auto now_ns = std::max(rig_.now_ns(), std::min({rig_.now_ns() + kStep_ns, change_ns, time_ns}));
    rig_.advance_to(now_ns);
    note_brakes(now_ns + offset_ns);
    if (change == nullptr || now_ns < change_ns) continue;
    for (std::size_t i = 0; i < bridge::kCardChannels; ++i) rig_.set_converter(i, change->codes[i]);
    rig_.set_outputs(change->levels);
    ++seen_output_changes_;
    change = next_output_change();
  }
  if (change == nullptr) take_lines();
  put_lines(at_ns);
}

/// Oldest change of the outputs that is not yet applied. Every change must be applied at its time, because
/// each toggle keeps the relay closed.
const bridge::OutputChange* RigServer::next_output_change() {
  const std::uint64_t count = lines_->output_change_count;
  if (seen_output_changes_ == count) return nullptr;
  if (count - seen_output_changes_ >= bridge::SharedLines::kOutputChanges)
    seen_output_changes_ = count - bridge::SharedLines::kOutputChanges +
                           1;  // the oldest entry may be overwritten during this call
  return &lines_->output_changes[seen_output_changes_ % bridge::SharedLines::kOutputChanges];
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
  seen_changes_ = lines_->changes;
  for (std::size_t i = 0; i < bridge::kCardChannels; ++i) rig_.set_converter(i, lines_->codes[i]);
  rig_.set_outputs(lines_->outputs);
}

void RigServer::put_lines(std::int64_t at_ns) {
  for (std::size_t i = 0; i < bridge::kCardChannels; ++i) lines_->pulses[i] = rig_.pulses(i);
  lines_->inputs = rig_.inputs();
  // Written last: a process that waits for one of these times then reads the lines of this time.
  lines_->lines_at_ns = std::max(at_ns, lines_->lines_at_ns.load());
  lines_->rig_time_ns = rig_.now_ns();
}

}  // namespace crane::emulated_rig
