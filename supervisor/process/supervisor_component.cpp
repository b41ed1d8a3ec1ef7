#include "crane/supervisor/component.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "crane/protection.hpp"
#include "crane/runtime/convert.hpp"
#include "crane/runtime/joined_component.hpp"
#include "crane/supervisor/supervisor.hpp"
#include "process/announcements.hpp"
#include "process/board_self_test.hpp"
#include "process/bridge_clock.hpp"
#include "process/command_echo.hpp"
#include "process/jog_reader.hpp"
#include "process/operator_requests.hpp"
#include "process/samples.hpp"
#include "process/sole_reader.hpp"
#include "process/step_timing.hpp"

namespace crane::supervisor {
namespace {

using runtime::Context;

// Longest wait for the demand / period: the command must reach the bridge in the same period.
constexpr double kWaitShare = 0.6;

class Supervisor : public runtime::JoinedComponent<msg::State, msg::Demand, msg::Reference> {
 public:
  explicit Supervisor(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::demand, topics::reference},
        limits_{limits_of(context.rig)},
        realtime_{context.clock == runtime::Clock::realtime},
        timing_{limits_.period_s, context.clock},
        echo_{{limits_.axis[0].present, limits_.axis[1].present, limits_.axis[2].present}, limits_.period_s},
        requests_{context, limits_},
        jogs_{context},
        sole_{context},
        commands_{context.ports.output(topics::command)},
        statuses_{context.ports.output(topics::supervisor)} {
    if (auto found = problems(limits_); !found.empty()) {
      for (auto& problem : found) problem.insert(0, context.rig.path + ": limits: ");
      throw configuration::ConfigurationError{std::move(found)};
    }
  }

 protected:
  void handle_requests(std::int64_t now_ns) override {
    now_ns_ = now_ns;
    sole_.take(now_ns);
    requests_.receive();
  }

  void on_tick(std::uint64_t tick, const msg::State* state, const msg::Demand* demand,
               const msg::Reference* reference) override {
    last_header_ = runtime::answer_to(state->header);
    if (!timing_.begins(demand != nullptr && reference != nullptr, now_ns_)) return;
    TickInput input;
    input.bridge_restarted = has_restarted();
    const auto verdict = bridge_clock_.take(state->header);
    if (verdict == BridgeClock::Verdict::begins_anew) input.bridge_restarted = true;
    if (verdict == BridgeClock::Verdict::contradicts) {
      if (!std::exchange(wrong_time_announced_, true)) announce_wrong_time(node(), state->header);
      state = nullptr;
    }
    const auto sampled_ns = sample_time_ns(tick, state);
    timing_.stepped(sampled_ns, now_ns_);
    input.now_s = seconds(sampled_ns);
    input.tick = tick;
    input.state_arrived = state != nullptr;
    if (state != nullptr) {
      input.sample = sample_of(*state);
      requests_.stepped(state->header, now_ns_);
    }
    if (demand != nullptr) {
      input.demand_arrived = true;
      input.demand_v = runtime::values(demand->total_v);
    }
    jogs_.take(last_header_, input.now_s);
    requests_.note_reference(reference);
    input.reference_moving = requests_.is_moving() || jogs_.session().active(input.now_s);
    input.second_writer =
        (demand != nullptr && demand->second_writer) || (reference != nullptr && reference->second_writer);
    if (input.bridge_restarted) {
      self_test_ = BoardSelfTest{limits_.period_s};
      echo_.restart();
    }
    input.self_test = self_test_.step(state);
    const bool foreign = realtime_ && state != nullptr &&
                         protection::enabled(protection::Protection::supervisor_echo) &&
                         echo_.contradicts(*state);
    if (foreign) note_foreign(input);
    step(input);
    if (foreign) give_up();
  }

  /// Steps the state machine without a sample when no state arrives: the bridge has ended, hangs or is
  /// disconnected. The command has the number of the last tick; a running bridge discards it. A late state
  /// does not end a move.
  bool on_idle(std::int64_t now_ns) override {
    if (const auto* state = open_leader(); state != nullptr && bridge_clock_.fits(state->header))
      (void)bridge_clock_.local_ns(state->header.sample_time_ns, now_ns);
    if (!timing_.is_silent(open_leader() != nullptr, now_ns)) return false;
    TickInput input;
    input.now_s = seconds(now_ns);
    input.tick = last_header_.tick;
    requests_.note_reference(nullptr);
    input.reference_moving = requests_.is_moving() || jogs_.session().active(input.now_s);
    input.self_test = self_test_.step(nullptr);
    step(input);
    return true;
  }
  [[nodiscard]] std::int64_t wake_at_ns() const override {
    return std::min(JoinedComponent::wake_at_ns(), timing_.due_ns(open_leader() != nullptr));
  }
  [[nodiscard]] bool steps_incomplete_ticks() const override { return true; }

 private:
  /// True in the first tick of another bridge.
  bool has_restarted() {
    if (restarts() == bridge_restarts_) return false;
    bridge_restarts_ = restarts();
    bridge_clock_ = BridgeClock{period_ns()};
    return true;
  }
  /// Local time of the sample; without a usable sample: the present time, in lockstep the nominal time of the
  /// tick.
  [[nodiscard]] std::int64_t sample_time_ns(std::uint64_t tick, const msg::State* state) {
    if (!realtime_)
      return state != nullptr ? state->header.sample_time_ns : static_cast<std::int64_t>(tick) * period_ns();
    return state != nullptr ? bridge_clock_.local_ns(state->header.sample_time_ns, now_ns_) : now_ns_;
  }
  [[nodiscard]] static double seconds(std::int64_t time_ns) { return static_cast<double>(time_ns) / 1e9; }
  [[nodiscard]] std::int64_t period_ns() const { return std::llround(limits_.period_s * 1e9); }

  /// Sets the input with which the last status of this process names the contradiction.
  void note_foreign(TickInput& input) const {
    if (echo_.voltage_contradicts())
      input.foreign_command = true;
    else if (input.self_test == SelfTest::running)
      input.self_test = SelfTest::failed;
    else
      input.brake_open_without_command = true;
  }

  /// The bridge executes forged commands; no command of this process can prevent this. When this process
  /// ends, its writer disappears: the bridge then drops all samples of this writer, forged samples included,
  /// and `crane up` ends the bridge with a signal.
  [[noreturn]] void give_up() {
    constexpr const char* kWhat =
        "the bridge outputs a voltage, or a brake is open, without a command of this supervisor";
    constexpr const char* kRemedy =
        "look at the brakes and their contacts; if they are sound, another program forges packets on this "
        "bus: end it, or use keys (crane up --secure)";
    node().error("foreign_commands", kWhat, kRemedy);
    throw std::runtime_error(std::string{kWhat} + "; " + kRemedy);
  }

  void step(TickInput& input) {
    input.second_writer = input.second_writer || ports().disputed(now_ns_) || sole_.disputed(now_ns_);
    input.configuration_differs = configuration() == 0;
    requests_.collect(input, memory_, now_ns_);
    const auto output = supervisor::step(limits_, input, memory_);
    requests_.take_answers(output, jogs_, input.now_s);
    jogs_.end_with(output.state, input.now_s);
    const auto command = command_of(last_header_, output);
    commands_.publish(command);
    echo_.commanded(command);
    const Mode mode = requests_.mode();
    statuses_.publish(status_of(last_header_, output, limits_, requests_.move(),
                                limited_stick(mode, jogs_.session().deflection(input.now_s)), mode));
    requests_.reply(last_header_);
    sole_.stepped(output.state);
    const bool stopped = input.bridge_restarted || (output.state != announced_ && is_stopped(output.state));
    if (stopped || requests_.stop_requested()) requests_.stopped(now_ns_);
    if (realtime_ && !limits_.machine.known && output.state == State::arming && announced_ != State::arming)
      announce_unchecked(node());
    if (output.state != announced_) announce(node(), limits_, output, memory_.homing_axis);
    announced_ = output.state;
  }

  /// True for the states during and after a stop.
  static bool is_stopped(State state) {
    return state == State::locked || state == State::estop || state == State::fault ||
           state == State::stop_c0 || state == State::stop_c1;
  }

  Limits limits_;
  bool realtime_;
  StepTiming timing_;
  CommandEcho echo_;
  BridgeClock bridge_clock_{period_ns()};
  OperatorRequests requests_;
  JogReader jogs_;
  SoleReader sole_;
  runtime::Output<msg::Command> commands_;
  runtime::Output<msg::SupervisorStatus> statuses_;
  BoardSelfTest self_test_{limits_.period_s};
  TickMemory memory_;
  msg::Header last_header_{};
  std::int64_t now_ns_ = 0;
  std::uint64_t bridge_restarts_ = 0;
  bool wrong_time_announced_ = false;
  State announced_ = State::boot;
};

}  // namespace

runtime::ComponentSpec supervisor_spec() {
  return {.name = "supervisor",
          .program = "crane_supervisor",
          .summary = "Safety states, limits, brakes and the command gate: the only writer of crane/command.",
          .source = crane_SOURCE_SUPERVISOR,
          .runs_controller = false,
          .reads = {{&topics::state.description, "what the rig measures: limits, brakes, latches"},
                    {&topics::demand.description, "volts for the gate"},
                    {&topics::reference.description, "whether a move is under way"},
                    {&topics::request.description,
                     "reset, arm, disarm, move, follow, jog, home, mode, stop, e-stop"},
                    {&topics::jog.description, "deflection of the operator's stick"},
                    {&topics::supervisor.description, "another supervisor of this crane"},
                    {&topics::node.description, "start-up number, process id and age of another supervisor"}},
          .writes = {{&topics::command.description, "volts, brakes, watchdog permission"},
                     {&topics::supervisor.description, "safety state, and the move that was accepted"},
                     {&topics::accepted_request.description, "accepted requests, for recordings"},
                     {&topics::accepted_jog.description, "accepted samples of the stick, for recordings"},
                     {&topics::reply.description, "answers to requests"}},
          .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
            return std::make_unique<Supervisor>(context);
          }};
}

}  // namespace crane::supervisor
