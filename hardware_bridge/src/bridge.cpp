#include "crane/bridge/bridge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "crane/bus/path_stamps.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::bridge {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

static_assert(static_cast<int>(Reason::not_homed) == crane_LATCH_NOT_HOMED);
static_assert(static_cast<int>(Reason::second_writer) == crane_LATCH_SECOND_WRITER);
static_assert(kReasons == crane_LATCH_SECOND_WRITER + 1);

std::vector<runtime::Read> bridge_reads() {
  return {{&topics::command.description, "volts, brakes, watchdog permission"},
          {&topics::request.description, "advance (lockstep), kick (simulated rigs)"}};
}

std::vector<runtime::Write> bridge_writes() {
  return {{&topics::state.description, "measurements, switches, brakes, and the voltage that acts"},
          {&topics::reply.description, "answers to requests"}};
}

namespace {

/// Largest age of the state that a command answers. The bridge ignores commands that answer an
/// older state, except 0 V with closed brakes. LastLine latches command_stale long before this age.
constexpr double kOldestAnswered_s = 1;

/// True for 0 V with closed brakes. Such a command is accepted with any sample time.
bool moves_nothing(const msg::Command& command) {
  return std::ranges::all_of(command.drive_v, [](double volts) { return volts == 0; }) &&
         std::ranges::none_of(command.brake_release, [](bool released) { return released; });
}

}  // namespace

Bridge::Bridge(const runtime::Context& context, std::unique_ptr<Board> board)
    : node_{context.node},
      clock_{context.clock},
      monotonic_ns_{context.monotonic_ns},
      period_ns_{std::llround(context.rig.period_s * 1e9)},
      board_{std::move(board)},
      measurement_{context.rig},
      last_line_{last_line_parameters(context.rig)},
      homing_{context.rig},
      probation_{context.rig.period_s},
      ports_{context.ports},
      states_{context.ports.output(topics::state)},
      commands_{context.ports.loop_input(topics::command)},
      requests_{context, {crane_REQUEST_ADVANCE, crane_REQUEST_KICK}},
      ticks_{kOldestAnswered_s, context.rig.period_s},
      drives_{context.rig.drives} {
  for (std::size_t i = 0; i < kDrives; ++i) {
    const auto& encoder = context.rig.encoders[i];
    unit_per_count_[i] = encoder.counts_per_unit > 0 ? encoder.sign / encoder.counts_per_unit : 0;
  }
  board_->make_safe();
  if (clock_ == runtime::Clock::lockstep && !board_->simulates_time())
    throw configuration::ConfigurationError(
        {context.rig.path + ": board = " + context.rig.board +
         ": a real rig does not wait for commands; start the stack with --clock realtime"});
}

Bridge::~Bridge() { board_->make_safe(); }

std::int64_t Bridge::wake_at_ns() const {
  if (clock_ == runtime::Clock::lockstep) return runtime::kNever;
  return tick_ ? start_ns_ + static_cast<std::int64_t>(*tick_ + 1) * period_ns_ : 0;
}

std::string Bridge::waiting_for() const {
  if (!tick_) return "an advance request";
  if (*tick_ >= until_tick_) return "an advance request beyond tick " + std::to_string(until_tick_);
  return "the command of tick " + std::to_string(*tick_);
}

bool Bridge::poll(std::int64_t now_ns) {
  take_requests(now_ns);
  take_commands(now_ns);
  node_.beat(now_ns, ports_, counts_);
  if (!tick_is_due(now_ns)) return false;
  const auto begin = steady_clock::now();
  const auto inputs = latch(now_ns);
  if (auto* const stamps = bus::path_stamps()) stamps->joined();
  tick(inputs, now_ns);
  node_.stepped(*tick_, 0, nanoseconds{steady_clock::now() - begin}.count());
  return true;
}

/// Latches all inputs. In real time, `now_ns` becomes the time of the latch, and a slow latch is repeated:
/// the computer may have paused between the reading of the clock and the latch.
Inputs Bridge::latch(std::int64_t& now_ns) {
  if (clock_ == runtime::Clock::lockstep) {
    board_->advance_to(static_cast<std::int64_t>(tick_ ? *tick_ + 1 : 0) * period_ns_);
    return board_->read();
  }
  constexpr int kMostLatches = 3;
  for (int i = 1;; ++i) {
    if (monotonic_ns_ != nullptr) now_ns = monotonic_ns_();
    board_->advance_to(now_ns - start_ns_);  // a simulated rig advances to the time of the latch
    const auto inputs = board_->read();
    const auto took_ns = monotonic_ns_ != nullptr ? monotonic_ns_() - now_ns : 0;
    if (i == kMostLatches || took_ns <= period_ns_ / 10) return inputs;
  }
}

bool Bridge::tick_is_due(std::int64_t now_ns) {
  if (clock_ == runtime::Clock::realtime) {
    if (!tick_) start_ns_ = now_ns;
    return now_ns >= wake_at_ns();
  }
  if (!tick_) return until_tick_ > 0;
  return *tick_ < until_tick_ && command_ && command_->tick == *tick_;
}

void Bridge::take_commands(std::int64_t now_ns) {
  std::size_t budget = runtime::LoopReader<msg::Command>::kMostPerPoll;
  while (const auto taken = commands_->take(now_ns, budget)) {
    const auto* command = &taken->sample;
    const bool answers_this_run = ticks_.time_of(command->header).has_value() || moves_nothing(*command);
    if (!tick_ || command->header.tick > *tick_ || !answers_this_run) {
      ++counts_.late;
      continue;
    }
    if (command_ && !taken->taken_over && command->header.tick <= command_->tick) {
      ++(command->header.tick == command_->tick ? counts_.duplicate : counts_.late);
      continue;
    }
    const bool new_writer = !command_ || taken->taken_over;
    const CommandView received{
        .tick = command->header.tick,
        .drive_v = runtime::values(command->drive_v),
        .brake_release = {command->brake_release[0], command->brake_release[1], command->brake_release[2]},
        .watchdog_permission = command->watchdog_permission,
        .homing = {command->homing[0], command->homing[1], command->homing[2]}};
    command_ = probation_.accepted(received, new_writer);
  }
}

void Bridge::take_requests(std::int64_t now_ns) {
  requests_.receive();
  while (const auto request = requests_.take_due(tick_.value_or(0) + 1, now_ns)) {
    if (request->kind == crane_REQUEST_ADVANCE) {
      until_tick_ = std::max(until_tick_, request->until_tick);
    } else {
      const bool kicked = board_->kick(request->kick_radps[0], request->kick_radps[1]);
      requests_.reply(*request, request->header, kicked,
                      kicked ? "" : "a real rig has no kick request: push the load by hand");
    }
  }
}

void Bridge::tick(const Inputs& inputs, std::int64_t now_ns) {
  std::uint64_t next = tick_ ? *tick_ + 1 : 0;
  std::int64_t sample_time_ns = static_cast<std::int64_t>(next) * period_ns_;
  if (clock_ == runtime::Clock::realtime) {
    const auto elapsed = static_cast<std::uint64_t>((now_ns - start_ns_) / period_ns_);
    if (now_ns - wake_at_ns() > period_ns_ / 2 && tick_) ++overruns_;
    counts_.lost += elapsed - next;
    next = elapsed;  // missed ticks are skipped
    sample_time_ns = now_ns;
  }
  const auto previous = tick_;
  tick_ = next;
  const auto measured = measurement_.step(inputs.raw_counts, latched_at(previous, next, sample_time_ns));
  report_relay(inputs, now_ns);
  ports_.watch(now_ns);
  auto now = observation(inputs);
  now.time_ns = sample_time_ns;
  now.second_writer = ports_.disputed(now_ns);
  apply(last_line_.decide(command_, next, now));
  auto sample = state(inputs, measured, sample_time_ns);
  ticks_.add(sample.header, now_ns);
  requests_.stepped(sample.header, now_ns);
  states_.publish(sample);
  ++counts_.completed;
  report_latch();
  step_homing(now);
}

/// Time of the sample of tick `next` relative to the nominal time of the tick.
Latched Bridge::latched_at(std::optional<std::uint64_t> previous, std::uint64_t next,
                           std::int64_t sample_time_ns) const {
  if (clock_ == runtime::Clock::lockstep) return {};
  const auto due_ns = start_ns_ + static_cast<std::int64_t>(next) * period_ns_;
  return {.ticks = previous ? next - *previous : 1,
          .late_s = static_cast<double>(sample_time_ns - due_ns) / 1e9};
}

/// Homes the axes. A position that becomes known is published from the next tick on; a doubtful position
/// becomes unknown.
void Bridge::step_homing(const Observation& observation) {
  for (std::size_t i = 0; i < kDrives; ++i) {
    if (last_line_.doubted()[i]) homing_.forget(i);
    const bool released = command_ && command_->brake_release[i] && last_line_.reason() == Reason::none;
    const auto change =
        homing_.step(i, {.counts = observation.counts[i],
                         .active = observation.mark[i],
                         .requested = command_ && command_->homing[i] && last_line_.reason() == Reason::none,
                         .free = released && !observation.brake_closed[i],
                         .rests = last_line_.rests(i)});
    if (!change) continue;
    measurement_.shift(i, *change);
    last_line_.shift(i, static_cast<double>(*change) * unit_per_count_[i]);
    node_.info("homed", std::string{"the position of the "} + plant::kCoordinates[i].name + " axis is known");
  }
}

/// Applies the signs of the wiring: commands are positive outward.
void Bridge::apply(Outputs outputs) {
  for (std::size_t i = 0; i < kDrives; ++i) outputs.drive_v[i] *= drives_[i].sign;
  applied_v_ = board_->write(outputs);
  for (std::size_t i = 0; i < kDrives; ++i) applied_v_[i] *= drives_[i].sign;
}

Observation Bridge::observation(const Inputs& inputs) const {
  Observation observation{.applied_v = applied_v_,
                          .brake_closed = inputs.brake_closed,
                          .limit_low = inputs.limit_low,
                          .limit_high = inputs.limit_high};
  for (std::size_t i = 0; i < kCounters; ++i) {
    observation.counts[i] = measurement_.coordinates()[i].counts();
    observation.coordinate[i] = measurement_.coordinates()[i].position();
  }
  for (std::size_t i = 0; i < kDrives; ++i) {
    observation.unknown[i] = !homing_.known(i);
    observation.mark[i] = mark_active(drives_[i], inputs, i);
  }
  return observation;
}

msg::State Bridge::state(const Inputs& inputs, const control::Measurement& measured,
                         std::int64_t sample_time_ns) const {
  msg::State sample{};
  sample.header.tick = *tick_;
  sample.header.sample_time_ns = sample_time_ns;
  for (std::size_t i = 0; i < kCounters; ++i) sample.counts[i] = measurement_.coordinates()[i].counts();
  sample.trolley_position_m = measured.position[control::kTrolley];
  sample.slew_angle_rad = measured.position[control::kSlew];
  sample.cable_length_m = measured.position[control::kHoist];
  sample.trolley_speed_mps = measured.speed[control::kTrolley];
  sample.slew_speed_radps = measured.speed[control::kSlew];
  sample.cable_speed_mps = measured.speed[control::kHoist];
  sample.swing_radial_rad = measured.swing_radial_rad;
  sample.swing_tangential_rad = measured.swing_tangential_rad;
  sample.swing_radial_radps = measured.swing_radial_radps;
  sample.swing_tangential_radps = measured.swing_tangential_radps;
  runtime::assign(sample.applied_v, applied_v_);
  sample.applied_command_tick = command_ ? command_->tick : 0;
  for (std::size_t i = 0; i < kDrives; ++i) {
    sample.brake_closed[i] = inputs.brake_closed[i];
    sample.limit_low[i] = inputs.limit_low[i];
    sample.limit_high[i] = inputs.limit_high[i];
    sample.position_known[i] = homing_.known(i);
    sample.mark_active[i] = mark_active(drives_[i], inputs, i);
    sample.mark_found[i] = homing_.found(i);
  }
  sample.estop_pressed = inputs.estop_pressed;
  const auto reason = last_line_.reason();
  sample.command_stale = reason == Reason::command_stale;
  sample.command_invalid = reason != Reason::none && reason != Reason::command_stale;
  sample.latch_reason = static_cast<crane_LatchReason>(reason);
  sample.watchdog_dropped = inputs.watchdog_dropped;
  sample.overruns = overruns_;
  sample.configuration = node_.identity().configuration;
  return sample;
}

void Bridge::report_latch() {
  const auto reason = last_line_.reason();
  if (reason != Reason::none && reason != reported_)
    node_.error(name_of(reason), std::string{explanation_of(reason)} + ": 0 V, brakes closed, latched",
                remedy_for(reason));
  reported_ = reason;
}

/// Reports a relay that opens without a latch of the bridge. Only the bridge knows the delays of the toggles.
void Bridge::report_relay(const Inputs& inputs, std::int64_t now_ns) {
  const auto interval_ns = now_ns - ticked_ns_;
  if (relay_closed_ && inputs.watchdog_dropped && toggles_ && !inputs.estop_pressed) {
    const auto late_ms = std::llround(static_cast<double>(std::max(interval_ns, interval_ns_)) * 1e-6);
    node_.error("relay_dropped",
                "the watchdog relay opened although the watchdog output toggled; the longer of the last two "
                "intervals between toggles was " +
                    std::to_string(late_ms) + " ms",
                "find the reason for late ticks of the bridge (overruns of crane/state), or check relay and "
                "relay_timeout_s, then `crane reset`");
  }
  relay_closed_ = !inputs.watchdog_dropped;
  toggles_ = command_ && command_->watchdog_permission && last_line_.reason() == Reason::none;
  ticked_ns_ = now_ns;
  interval_ns_ = interval_ns;
}

}  // namespace crane::bridge
