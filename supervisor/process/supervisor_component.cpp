#include "process/supervisor_component.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "crane/runtime/convert.hpp"
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/request_inbox.hpp"
#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {
namespace {

using runtime::Context;

/// The logic's numbers are those of crane.idl, one by one.
template <class Logic, class Idl>
constexpr bool same(Logic logic, Idl idl) {
  return static_cast<int>(logic) == static_cast<int>(idl);
}
static_assert(same(State::boot, crane_STATE_BOOT));
static_assert(same(State::selftest, crane_STATE_SELFTEST));
static_assert(same(State::locked, crane_STATE_LOCKED));
static_assert(same(State::ready, crane_STATE_READY));
static_assert(same(State::arming, crane_STATE_ARMING));
static_assert(same(State::hold, crane_STATE_HOLD));
static_assert(same(State::run, crane_STATE_RUN));
static_assert(same(State::stop_c1, crane_STATE_STOP_C1));
static_assert(same(State::stop_c0, crane_STATE_STOP_C0));
static_assert(same(State::estop, crane_STATE_ESTOP));
static_assert(same(State::fault, crane_STATE_FAULT));
static_assert(same(Cause::none, crane_CAUSE_NONE));
static_assert(same(Cause::start, crane_CAUSE_START));
static_assert(same(Cause::operator_stop, crane_CAUSE_OPERATOR_STOP));
static_assert(same(Cause::operator_disarm, crane_CAUSE_OPERATOR_DISARM));
static_assert(same(Cause::operator_estop, crane_CAUSE_OPERATOR_ESTOP));
static_assert(same(Cause::estop_input, crane_CAUSE_ESTOP_INPUT));
static_assert(same(Cause::idle, crane_CAUSE_IDLE));
static_assert(same(Cause::state_stale, crane_CAUSE_STATE_STALE));
static_assert(same(Cause::demand_stale, crane_CAUSE_DEMAND_STALE));
static_assert(same(Cause::demand_invalid, crane_CAUSE_DEMAND_INVALID));
static_assert(same(Cause::demand_rate, crane_CAUSE_DEMAND_RATE));
static_assert(same(Cause::bridge_latched, crane_CAUSE_BRIDGE_LATCHED));
static_assert(same(Cause::position_limit, crane_CAUSE_POSITION_LIMIT));
static_assert(same(Cause::stopping_envelope, crane_CAUSE_STOPPING_ENVELOPE));
static_assert(same(Cause::limit_switch, crane_CAUSE_LIMIT_SWITCH));
static_assert(same(Cause::overspeed, crane_CAUSE_OVERSPEED));
static_assert(same(Cause::swing_limit, crane_CAUSE_SWING_LIMIT));
static_assert(same(Cause::brake_did_not_close, crane_CAUSE_BRAKE_DID_NOT_CLOSE));
static_assert(same(Cause::brake_did_not_open, crane_CAUSE_BRAKE_DID_NOT_OPEN));
static_assert(same(Cause::second_writer, crane_CAUSE_SECOND_WRITER));
static_assert(same(Cause::overrun, crane_CAUSE_OVERRUN));
static_assert(same(Cause::selftest_failed, crane_CAUSE_SELFTEST_FAILED));
static_assert(same(Cause::stop_timeout, crane_CAUSE_STOP_TIMEOUT));

constexpr double kWaitShare = 0.6;      // of a period, for the demand: the last hop before the bridge
constexpr double kSilentPeriods = 1.5;  // without a state: the step is due all the same
constexpr int kSelfTestTicks = 10;      // quiet in a row
constexpr int kSelfTestLongestTicks = 200;
constexpr int kTicksToTakeUp = 20;  // from the acceptance of a move until the planner follows it
constexpr double kLongestFollow_s = 3600;
constexpr double kSlewStandstill_radps = 0.01;
constexpr double kSlewBrakeSlip_rad = 0.05;

std::optional<Request> request_of(crane_RequestKind kind) {
  switch (kind) {
    case crane_REQUEST_RESET:
      return Request::reset;
    case crane_REQUEST_ARM:
      return Request::arm;
    case crane_REQUEST_DISARM:
      return Request::disarm;
    case crane_REQUEST_MOVE:
    case crane_REQUEST_FOLLOW:
      return Request::move;
    case crane_REQUEST_STOP:
      return Request::stop;
    case crane_REQUEST_ESTOP:
      return Request::estop;
    default:
      return std::nullopt;
  }
}

bool moves_axes(const msg::Request& request) {
  return request.kind == crane_REQUEST_MOVE || request.kind == crane_REQUEST_FOLLOW;
}

/// Farthest from its target, and fastest, that the sum of sines of a request can be.
struct Excursion {
  double distance = 0, speed = 0;
};
Excursion excursion_of(const msg::Request& request) {
  Excursion sum;
  if (request.kind != crane_REQUEST_FOLLOW) return sum;
  for (const auto& sine : request.sine) {
    sum.distance += std::abs(sine.amplitude);
    sum.speed += std::abs(sine.amplitude * 2 * std::numbers::pi * sine.frequency_hz);
  }
  return sum;
}

Sample sample_of(const msg::State& state) {
  Sample sample;
  sample.position = {state.trolley_position_m, state.slew_angle_rad, state.cable_length_m};
  sample.swing_radial_rad = state.swing_radial_rad;
  sample.swing_tangential_rad = state.swing_tangential_rad;
  for (std::size_t i = 0; i < kAxes; ++i) {
    sample.brake_closed[i] = state.brake_closed[i];
    sample.limit_low[i] = state.limit_low[i];
    sample.limit_high[i] = state.limit_high[i];
  }
  sample.estop_pressed = state.estop_pressed;
  sample.command_stale = state.command_stale;
  sample.command_invalid = state.command_invalid;
  sample.watchdog_dropped = state.watchdog_dropped;
  sample.overruns = state.overruns;
  return sample;
}

/// Before anything may be armed: the board answers with 0 V, every brake closed and the watchdog relay open,
/// for a while without a break.
class StartUpTest {
 public:
  SelfTest step(const msg::State* state) {
    if (result_ != SelfTest::running && result_ != SelfTest::not_started) return result_;
    result_ = SelfTest::running;
    if (state == nullptr) return result_;
    quiet_ = is_quiet(*state) ? quiet_ + 1 : 0;
    if (quiet_ >= kSelfTestTicks)
      result_ = SelfTest::passed;
    else if (++ticks_ >= kSelfTestLongestTicks)
      result_ = SelfTest::failed;
    return result_;
  }

 private:
  static bool is_quiet(const msg::State& state) {
    for (std::size_t i = 0; i < kAxes; ++i)
      if (state.applied_v[i] != 0 || !state.brake_closed[i]) return false;
    return state.watchdog_dropped;  // without permission the relay must have taken the brake supply away
  }
  SelfTest result_ = SelfTest::not_started;
  int quiet_ = 0, ticks_ = 0;
};

class Supervisor : public runtime::JoinedComponent<msg::State, msg::Demand, msg::Reference> {
 public:
  explicit Supervisor(const Context& context)
      : JoinedComponent{context, runtime::join_policy(context, kWaitShare),
                        context.bus.subscriber(topics::state, runtime::loop_endpoint(context.clock)),
                        context.bus.subscriber(topics::demand, runtime::loop_endpoint(context.clock)),
                        context.bus.subscriber(topics::reference, runtime::loop_endpoint(context.clock))},
        limits_{limits_of(context.rig)},
        realtime_{context.clock == runtime::Clock::realtime},
        requests_{context,
                  {crane_REQUEST_RESET, crane_REQUEST_ARM, crane_REQUEST_DISARM, crane_REQUEST_MOVE,
                   crane_REQUEST_FOLLOW, crane_REQUEST_STOP, crane_REQUEST_ESTOP}},
        commands_{context.bus.publisher(topics::command, runtime::loop_endpoint(context.clock))},
        statuses_{context.bus.publisher(topics::supervisor, runtime::loop_endpoint(context.clock))} {
    if (auto found = problems(limits_); !found.empty()) {
      for (auto& problem : found) problem.insert(0, context.rig.path + ": limits: ");
      throw runtime::ConfigurationError{std::move(found)};
    }
  }

 protected:
  void handle_requests(std::int64_t /*now_ns*/) override { requests_.receive(); }

  void on_tick(std::uint64_t tick, const msg::State* state, const msg::Demand* demand,
               const msg::Reference* reference) override {
    last_header_ = runtime::answer_to(state->header);
    last_step_ns_ = state->header.sample_time_ns;
    TickInput input;
    input.now_s = static_cast<double>(state->header.sample_time_ns) * 1e-9;
    input.tick = tick;
    input.state_arrived = true;
    input.sample = sample_of(*state);
    if (demand != nullptr) {
      input.demand_arrived = true;
      input.demand_v = runtime::values(demand->total_v);
    }
    input.reference_moving = is_moving(reference);
    input.self_test = self_test_.step(state);
    step(input);
  }

  /// No state comes: the bridge is dead, hung or cut off. Says so, and asks for nothing.
  bool on_idle(std::int64_t now_ns) override {
    if (!realtime_ || last_step_ns_ == 0 || now_ns < silence_ends_ns()) return false;
    last_step_ns_ = now_ns;
    TickInput input;
    input.now_s = static_cast<double>(now_ns) * 1e-9;
    input.tick = last_header_.tick;
    input.self_test = self_test_.step(nullptr);
    step(input);
    return true;
  }
  [[nodiscard]] std::int64_t wake_at_ns() const override {
    const auto due = JoinedComponent::wake_at_ns();
    return realtime_ && last_step_ns_ != 0 ? std::min(due, silence_ends_ns()) : due;
  }
  [[nodiscard]] bool steps_incomplete_ticks() const override { return true; }
  [[nodiscard]] bool outputs_connected() const override { return commands_.matched() > 0; }

 private:
  /// From the acceptance of a move until its reference has ended. A planner that never takes the move up, and
  /// a reference that is missing for a tick, must not decide about RUN.
  bool is_moving(const msg::Reference* reference) {
    if (reference != nullptr) {
      reference_moving_ = reference->moving;
      if (reference->request_id == move_id_) ticks_to_take_up_ = 0;
    }
    if (ticks_to_take_up_ > 0) --ticks_to_take_up_;
    return reference_moving_ || ticks_to_take_up_ > 0;
  }
  [[nodiscard]] std::int64_t silence_ends_ns() const {
    return last_step_ns_ + static_cast<std::int64_t>(kSilentPeriods * limits_.period_s * 1e9);
  }

  void step(TickInput& input) {
    input.second_writer = counts().conflicting > conflicts_;
    conflicts_ = counts().conflicting;
    const auto asked = collect(input);
    const auto output = supervisor::step(limits_, input, memory_);
    for (const auto& request : asked) answer(request, output);
    publish_command(output);
    publish_status(output);
    announce(output);
  }

  /// Requests due on this tick; a target outside the travel is refused here and goes no further.
  std::vector<msg::Request> collect(TickInput& input) {
    std::vector<msg::Request> asked;
    while (const auto request = requests_.take_due(input.tick)) {
      if (moves_axes(*request))
        if (const auto problem = target_problem(*request); !problem.empty()) {
          requests_.reply(*request, last_header_, false, problem);
          continue;
        }
      input.requests[static_cast<std::size_t>(*request_of(request->kind))] = true;
      asked.push_back(*request);
    }
    return asked;
  }

  [[nodiscard]] std::string target_problem(const msg::Request& request) const {
    constexpr std::array kAxisNames{"trolley", "slew", "hoist"};
    const auto excursion = excursion_of(request);
    int selected = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!request.selected[i]) continue;
      ++selected;
      const auto& axis = limits_.axis[i];
      if (!axis.present) return std::string{"this rig has no "} + kAxisNames[i] + " drive";
      for (const double target :
           {request.target[i] - excursion.distance, request.target[i] + excursion.distance})
        if (!target_allowed(axis, target))
          return std::string{kAxisNames[i]} + " target " + std::to_string(target) + " must lie in [" +
                 std::to_string(axis.low_limit + axis.soft_margin) + ", " +
                 std::to_string(axis.high_limit - axis.soft_margin) + "]";
      if (!(excursion.speed <= axis.max_speed))
        return std::string{kAxisNames[i]} + " speed " + std::to_string(excursion.speed) +
               " of the sines must be at most " + std::to_string(axis.max_speed);
    }
    if (selected == 0) return "no axis selected";
    if (request.kind != crane_REQUEST_FOLLOW) return "";
    if (selected != 1) return "follow: select exactly one axis";
    if (!std::ranges::all_of(request.sine, [](const auto& sine) { return std::isfinite(sine.phase_rad); }))
      return "follow: phase_rad must be finite";
    const bool lasts = request.duration_s >= 0 && request.duration_s <= kLongestFollow_s;
    return lasts ? "" : "follow: duration_s must lie in [0, 3600]";
  }

  void answer(const msg::Request& request, const TickOutput& output) {
    const auto& verdict = output.answers[static_cast<std::size_t>(*request_of(request.kind))];
    if (moves_axes(request) && verdict.accepted) {
      move_id_ = request.id;
      ticks_to_take_up_ = kTicksToTakeUp;
    }
    requests_.reply(request, last_header_, verdict.accepted, verdict.reason);
  }

  void publish_command(const TickOutput& output) {
    msg::Command command{};
    command.header = last_header_;
    runtime::assign(command.drive_v, output.drive_v);
    for (std::size_t i = 0; i < kAxes; ++i) command.brake_release[i] = output.brake_release[i];
    command.watchdog_permission = output.watchdog_permission;
    commands_.publish(command);
  }

  void publish_status(const TickOutput& output) {
    msg::SupervisorStatus status{};
    status.header = last_header_;
    status.state = static_cast<crane_SupervisorState>(output.state);
    status.cause = static_cast<crane_Cause>(output.cause);
    status.state_stale = output.flags.state_stale;
    status.demand_stale = output.flags.demand_stale;
    status.demand_invalid = output.flags.demand_invalid;
    status.demand_clamped = output.flags.demand_clamped;
    status.envelope_violated = output.flags.envelope_violated;
    status.swing_exceeded = output.flags.swing_exceeded;
    status.bridge_latched = output.flags.bridge_latched;
    status.estop_active = output.flags.estop_active;
    status.second_writer = output.flags.second_writer;
    for (std::size_t i = 0; i < kAxes; ++i) {
      status.low_limit[i] = limits_.axis[i].low_limit;
      status.high_limit[i] = limits_.axis[i].high_limit;
      status.volt_limit_v[i] = limits_.axis[i].volt_limit_v;
    }
    status.clamped_count = output.clamped_count;
    status.rejected_count = output.rejected_count;
    status.missing_demand_count = output.missing_demand_count;
    status.request_id = move_id_;
    statuses_.publish(status);
  }

  void announce(const TickOutput& output) {
    if (output.state == announced_) return;
    announced_ = output.state;
    const std::string what =
        std::string{name_of(output.state)} +
        (output.cause == Cause::none ? "" : std::string{" because of "} + name_of(output.cause));
    const bool asked_for = output.cause == Cause::operator_stop || output.cause == Cause::operator_disarm ||
                           output.cause == Cause::idle;
    const bool trouble = output.state >= State::stop_c1 && !asked_for;
    if (trouble)
      node().error("supervisor_state", what, remedy_for(output.cause));
    else
      node().info("supervisor_state", what);
  }

  Limits limits_;
  bool realtime_;
  runtime::RequestInbox requests_;
  bus::Publisher<msg::Command> commands_;
  bus::Publisher<msg::SupervisorStatus> statuses_;
  StartUpTest self_test_;
  TickMemory memory_;
  msg::Header last_header_{};
  std::int64_t last_step_ns_ = 0;
  std::uint64_t conflicts_ = 0;
  std::uint64_t move_id_ = 0;
  int ticks_to_take_up_ = 0;
  bool reference_moving_ = false;
  State announced_ = State::boot;
};

}  // namespace

Limits limits_of(const runtime::Rig& rig) {
  Limits limits;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = rig.drives[i];
    auto& axis = limits.axis[i];
    axis.present = drive.present;
    axis.volt_limit_v = drive.volt_limit_v;
    axis.volt_rate_limit_vps = drive.volt_rate_limit_vps;
    axis.low_limit = drive.low_limit;
    axis.high_limit = drive.high_limit;
    axis.soft_margin = drive.soft_margin;
    axis.max_speed = drive.max_speed;
    axis.brake_deceleration = drive.brake_deceleration;
    axis.brake_close_time_s = drive.brake_close_time_s;
    axis.brake_open_time_s = drive.brake_open_time_s;
  }
  limits.axis[plant::kSlew].standstill_speed = kSlewStandstill_radps;
  limits.axis[plant::kSlew].brake_slip = kSlewBrakeSlip_rad;
  limits.period_s = rig.period_s;
  limits.swing_limit_rad = rig.limits.swing_limit_rad;
  limits.demand_stale_after_ticks = rig.limits.demand_stale_after_ticks;
  limits.idle_lock_s = rig.limits.idle_lock_s;
  return limits;
}

runtime::ComponentSpec supervisor_spec() {
  return {.name = "supervisor",
          .program = "crane_supervisor",
          .summary = "Safety states, limits, brakes and the command gate: the only writer of crane/command.",
          .source = crane_SOURCE_SUPERVISOR,
          .runs_controller = false,
          .sole_writer_of = &topics::command.description,
          .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
            return std::make_unique<Supervisor>(context);
          }};
}

}  // namespace crane::supervisor
