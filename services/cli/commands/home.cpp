/// crane home: homes one axis after the other.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "cli/number_range.hpp"
#include "cli/operator_request.hpp"
#include "commands.hpp"
#include "crane/bus/newest.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::cli {
namespace {

struct HomeOptions {
  std::vector<std::string> axes;
  double timeout_s = 300;
  runtime::BusOptions bus = tool_bus();
};

/// The newest samples of crane/supervisor and crane/state.
class Watch {
 public:
  explicit Watch(bus::Bus& bus)
      : bus_{bus}, statuses_{bus.subscriber(topics::supervisor)}, states_{bus.subscriber(topics::state)} {}

  /// Waits until `holds` returns true. @return false at the timeout
  /// @throws std::runtime_error after a stop signal, or when the supervisor has been silent for kSilent_ns
  bool until(double timeout_s,
             const std::function<bool(const msg::SupervisorStatus&, const msg::State&)>& holds) {
    std::int64_t looked_ns = runtime::monotonic_ns();
    const bool reached = wait_until(bus_, timeout_s, [&] {
      const auto now_ns = runtime::monotonic_ns();
      if (bus::take_newest(statuses_, status_)) status_arrived_ns_ = now_ns;
      bus::take_newest(states_, state_);
      if (now_ns - std::exchange(looked_ns, now_ns) > kSilent_ns)
        throw std::runtime_error(
            "home: this program was suspended for more than 2 s: look at `crane status`, and repeat "
            "`crane home`");
      if (status_ && now_ns - status_arrived_ns_ > kSilent_ns)
        throw std::runtime_error(
            "home: no sample of crane/supervisor for 2 s: the stack has ended, or its host cannot be "
            "reached; "
            "see `crane status`");
      return status_ && state_ && holds(*status_, *state_);
    });
    if (runtime::stop_requested())
      throw std::runtime_error(
          "home: waiting was interrupted; the crane continues to move (stop it with `crane stop`)");
    return reached;
  }
  [[nodiscard]] const msg::State& state() const { return *state_; }
  [[nodiscard]] const msg::SupervisorStatus& status() const { return *status_; }

 private:
  static constexpr std::int64_t kSilent_ns = 2'000'000'000;

  bus::Bus& bus_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  bus::Subscriber<msg::State> states_;
  std::optional<msg::SupervisorStatus> status_;
  std::optional<msg::State> state_;
  std::int64_t status_arrived_ns_ = 0;  ///< CLOCK_MONOTONIC, arrival of `status_`
};

/// Order of homing. The hoist is first, because a short cable reduces the swing. The slew axis is last,
/// because its gains depend on the trolley position.
std::vector<std::size_t> axes_to_home(const HomeOptions& options, const msg::State& state) {
  std::vector<std::size_t> axes;
  for (const std::size_t axis : {2U, 0U, 1U}) {
    const bool named = std::ranges::find(options.axes, plant::kCoordinates[axis].name) != options.axes.end();
    if (options.axes.empty() ? !state.position_known[axis] : named) axes.push_back(axis);
  }
  return axes;
}

[[noreturn]] void throw_stopped(const msg::SupervisorStatus& status) {
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  const auto failure = static_cast<supervisor::HomingFailure>(status.homing_failure);
  std::string why = supervisor::name_of(cause);
  if (cause == supervisor::Cause::homing_failed)
    why += std::string{": "} + supervisor::name_of(failure) + ": " + supervisor::remedy_for(failure);
  else
    why += std::string{": "} + supervisor::remedy_for(cause);
  throw std::runtime_error("home: stopped because of " + why);
}

/// Waits from the acceptance of the request until the position is known. @throws std::runtime_error
void follow(Watch& watch, std::size_t axis, double timeout_s) {
  bool began = false;
  const bool done = watch.until(timeout_s, [&](const msg::SupervisorStatus& status, const msg::State& state) {
    began = began || status.homing[axis];
    if (!began || status.homing[axis]) return false;
    if (status.cause != crane_CAUSE_HOMED) throw_stopped(status);
    return state.position_known[axis];
  });
  if (!done)
    throw std::runtime_error(
        "home: not complete before the timeout; the crane continues to move (stop it with `crane stop`)");
}

/// Resets the stop that ends the homing of an axis. Requests a reset every 0.2 s, at most 20 times: the
/// supervisor accepts it one second after the cause. Each request names the status that it answers: the
/// supervisor refuses it if an operator has stopped the crane since.
void reset_after_homing(bus::Bus& bus, Watch& watch) {
  constexpr double kStops_s = 5;
  constexpr int kTries = 20;
  const auto is_stop_of_homing = [](const msg::SupervisorStatus& status) {
    return status.cause == crane_CAUSE_HOMED;
  };
  Answer answer;
  for (int i = 0; i < kTries && !answer.accepted; ++i) {
    if (i > 0) watch.until(0.2, [](const auto&, const auto&) { return false; });
    watch.until(kStops_s, [&](const msg::SupervisorStatus& status, const msg::State&) {
      return status.state == crane_STATE_LOCKED || !is_stop_of_homing(status);
    });
    if (!is_stop_of_homing(watch.status())) throw_stopped(watch.status());
    answer = ask(bus, {.kind = crane_REQUEST_RESET, .newest_status = watch.status().header});
  }
  if (!answer.accepted) throw std::runtime_error("home: reset refused: " + answer.reason);
}

int home(const HomeOptions& options) {
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  Watch watch{bus};
  constexpr double kDiscovery_s = 5;
  if (!watch.until(kDiscovery_s, [](const auto&, const auto&) { return true; }))
    throw NoAnswer("no sample of crane/supervisor or crane/state received" + where_and_remedy(bus));
  const auto axes = axes_to_home(options, watch.state());
  if (axes.empty()) std::cout << "home: the position of every axis is known\n";
  bool first = true;
  for (const auto axis : axes) {
    if (!first) reset_after_homing(bus, watch);
    first = false;
    stack::OperatorRequest wanted{.kind = crane_REQUEST_HOME};
    wanted.selected[axis] = true;
    if (const auto answer = ask(bus, wanted); !answer.accepted) return report("home", answer);
    follow(watch, axis, options.timeout_s);
    std::cout << "home: " << plant::kCoordinates[axis].name << " done" << std::endl;
  }
  return runtime::kExitDone;
}

}  // namespace

void add_home(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<HomeOptions>();
  auto* command = app.add_subcommand(
      "home",
      "Home the axes one after another: an axis moves slowly to its mark, then its position is known");
  command
      ->add_option("--axis", options->axes,
                   "trolley, slew or hoist (repeatable); default: all axes that are not homed")
      ->check(CLI::IsMember(plant::drive_names()));
  command->add_option("--timeout", options->timeout_s, "longest wait for one axis in s")
      ->check(number_in(kShortestWait_s, kLongestWait_s))
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Example: crane reset && crane home && sleep 2 && crane reset && crane arm\n"
      "The crane must be READY. Only the brake of the axis that is being homed opens. The axis moves\n"
      "slowly to its homing mark ([homing] in the rig file), backs off, and moves to the mark again.\n"
      "The final state is LOCKED. A person must stand at the emergency stop.");
  command->callback([options, &chosen] { chosen = [options] { return home(*options); }; });
}

}  // namespace crane::cli
