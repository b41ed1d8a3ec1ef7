#include "experiments/realtime_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "crane/boards/board_uses.hpp"
#include "crane/files/temporary_directory.hpp"
#include "experiments/realtime_session.hpp"
#include "experiments/rig_at_start_file.hpp"
#include "stack/launch.hpp"

namespace crane::experiments {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;
using namespace std::string_literals;

struct Action {
  double at_s;
  stack::OperatorRequest wanted;
};

std::vector<Action> actions_of(const experiment::Scenario& scenario) {
  std::vector<Action> actions;
  for (const auto& move : scenario.moves) {
    stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
    for (std::size_t i = 0; i < wanted.target.size(); ++i) {
      wanted.selected[i] = move.target[i].has_value();
      wanted.target[i] = move.target[i].value_or(0);
    }
    actions.push_back({move.at_s, wanted});
  }
  for (const auto& excitation : scenario.excitations)
    actions.push_back({excitation.at_s, stack::request_to_follow(excitation.reference)});
  std::ranges::stable_sort(actions, {}, &Action::at_s);
  return actions;
}

/// Longest wait for the arrival at the start, and longest wait for the load to come to rest there. It must be
/// shorter than idle_lock_s (60 s), after which the supervisor locks an idle crane.
constexpr auto kPatience = 30s;
/// Longest delay of a state. Without states, the supervisor stops the crane earlier.
constexpr auto kLate = 2s;

/// @return whether the load is at rest
bool go_to_scenario_start(RealtimeSession& session, const experiment::Scenario& scenario) {
  stack::OperatorRequest wanted;
  bool any = false;
  for (std::size_t i = 0; i < wanted.target.size(); ++i) {
    if (!scenario.start[i]) continue;
    any = wanted.selected[i] = true;
    wanted.target[i] = *scenario.start[i];
  }
  return !any || session.move_to(wanted.selected, wanted.target, kPatience);
}

std::string swinging_start(const msg::State& state) {
  std::ostringstream text;
  text << "the load still swings " << kPatience.count() << " s after the move to the start: radial "
       << state.swing_radial_rad << " rad, tangential " << state.swing_tangential_rad << " rad; trolley at "
       << state.trolley_position_m << " m, slew at " << state.slew_angle_rad << " rad, cable "
       << state.cable_length_m << " m";
  return text.str();
}

/// @return a sentence when the request of `at_s` was sent at least 20 ms and two periods late
std::optional<std::string> lateness(double at_s, double sent_s, double period_s) {
  constexpr double kLate_s = 0.02;
  if (sent_s - at_s < std::max(kLate_s, 2 * period_s)) return std::nullopt;
  std::ostringstream text;
  text << "the request of " << at_s << " s was sent " << sent_s - at_s
       << " s late: this program was suspended, or the computer was too busy";
  return text.str();
}

/// Longest time between the last state and the end of the processes. An operator who resets and arms the
/// crane in this time cannot have moved it: a reset and the test of the brakes last longer.
constexpr std::int64_t kUnobserved_ns = 1'000'000'000;

/// Call when the processes have ended. @return reason why the bridge must not start at the last position
std::string end_problem(const RealtimeSession& session, const configuration::Rig& rig, bool load_at_rest) {
  const msg::State& last = *session.state();
  if (session.taken_over()) return "another operator has reset the crane after the run before";
  if (runtime::monotonic_ns() - last.header.sample_time_ns > kUnobserved_ns)
    return "the end of the run before was not observed: this program was suspended, or the computer was too "
           "busy";
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (rig.drives[i].present && !last.brake_closed[i])
      return "the brakes were open at the end of the run before";
  if (!load_at_rest)
    return "the load still swings after the run before, and the bridge sets the swing to zero: wait until "
           "the "
           "load hangs at rest";
  return {};
}

constexpr const char* kGoOn = ". Set [start] to the present position, and start the remaining runs";

std::int64_t ns(double time_s) { return static_cast<std::int64_t>(std::llround(time_s * 1e9)); }

}  // namespace

RealtimeRuns::RealtimeRuns(RealtimeRunOptions options) : options_{std::move(options)} {}
RealtimeRuns::~RealtimeRuns() = default;

RealtimeRuns::End RealtimeRuns::observed_end(RealtimeSession& session, const configuration::Rig& rig,
                                             bool load_at_rest) {
  std::string problem;
  try {
    session.wait(100ms);  // the last states of the bridge
    problem = end_problem(session, rig, load_at_rest);
  } catch (const SessionError& error) {  // Ctrl-C: the completed run is kept
    problem = error.what();
  }
  const msg::State& last = *session.state();
  return {{last.trolley_position_m, last.slew_angle_rad, last.cable_length_m}, problem};
}

std::string difference_from_start(const configuration::Rig& rig, const std::array<double, 3>& position) {
  constexpr double kSame = 1e-3;  // m or rad: nearer than a person can place an axis
  std::ostringstream text;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& drive = rig.drives[i];
    const double start = rig.start.position[i];
    if (!drive.present || drive.zero != control::Zero::start || std::abs(position[i] - start) < kSame)
      continue;
    const auto& axis = plant::kCoordinates[i];
    text << (text.str().empty() ? "" : ", ") << axis.name << " at " << position[i] << ' ' << axis.unit
         << " ([start] " << start << ')';
  }
  if (text.str().empty()) return {};
  return "the axes do not stand at [start]: " + text.str() +
         "; before the next program starts, move them there by hand, or correct [start] in " + rig.path;
}

std::string RealtimeRuns::difference_from_start(const configuration::Rig& rig) const {
  return end_ ? experiments::difference_from_start(rig, end_->position) : std::string{};
}

RealtimeRun RealtimeRuns::run(const std::filesystem::path& rig_file, const std::string& controller,
                              const experiment::Scenario& scenario) {
  if (!end_) return run_from_start(rig_file, controller, scenario);
  if (!end_->problem.empty()) throw SessionError(end_->problem + kGoOn);
  auto rig = configuration::load_rig(rig_file);
  rig.start.position = end_->position;
  const files::TemporaryDirectory directory{"crane_run"};
  const auto started = directory.path() / "rig.toml";
  write_rig_at_start(started, rig);
  return run_from_start(started, controller, scenario);
}

void RealtimeRuns::require_sole_use() {
  // While the bridge of this run has the board, no other bridge can open it and move the crane.
  if (board_uses_->count() != ++bridges_)
    throw SessionError(
        "another hardware bridge has used the board since the run before: the crane may have moved"s + kGoOn);
}

RealtimeRun RealtimeRuns::run_from_start(const std::filesystem::path& rig_file, const std::string& controller,
                                         const experiment::Scenario& scenario) {
  const bool real = options_.plant == stack::Plant::hardware;
  const auto specs = stack::stack_with(options_.plant);
  stack::LaunchOptions launch_options{
      .bus = options_.bus, .vendors = options_.vendors, .rig = rig_file.string(), .controller = controller};
  if (!real) launch_options.bus.crane += "_run_" + std::to_string(::getpid());
  const auto rig = configuration::load_rig(rig_file);
  if (real && board_uses_ == nullptr)
    board_uses_ = std::make_unique<bridge::BoardUses>(rig, options_.bus.crane, options_.bus.domain);
  stack::ChildProcesses children;
  if (real) stack::launch_rig(children, rig, launch_options);
  stack::launch(children, specs, launch_options);
  auto observer = launch_options.bus;
  observer.vendor = "fastdds";  // as for all tools, so that every run uses both vendors
  bus::Bus bus{runtime::bus_options(observer, "crane_run", crane_SOURCE_OPERATOR, 0)};
  stack::wait_until_ready(children, specs, bus, 15s);
  if (real) require_sole_use();
  RealtimeSession session{bus, [&children] {
                            if (const auto ended = children.ended())
                              throw SessionError(stack::describe(*ended));
                            if (runtime::stop_requested()) throw SessionError("interrupted");
                          }};
  session.end_at_stops();
  session.arm();
  RealtimeRun run;
  if (!go_to_scenario_start(session, scenario)) run.differences.push_back(swinging_start(*session.state()));
  session.wait(0s);  // the newest state, also after a suspension of this program
  session.start_table();
  const auto zero_ns = session.state()->header.sample_time_ns;
  for (const Action& action : actions_of(scenario)) {
    session.wait_for_sample(zero_ns + ns(action.at_s), kLate);
    // The bridge runs on this computer and stamps its states with the same clock.
    const double sent_s = 1e-9 * static_cast<double>(runtime::monotonic_ns() - zero_ns);
    if (auto late = lateness(action.at_s, sent_s, rig.period_s)) run.differences.push_back(*std::move(late));
    session.request(action.wanted, action.wanted.kind == crane_REQUEST_MOVE ? "move" : "follow");
  }
  session.wait_for_sample(zero_ns + ns(scenario.end_s()), kLate);
  run.table = session.table().table(zero_ns);
  if (const auto missing = recording::missing_ticks(run.table); !missing.empty())
    run.differences.push_back(missing + ": this program was suspended, or the computer was too busy");
  const bool at_rest = !real || !rig.has_load() || session.wait_for_rest(kPatience);
  session.disarm();
  children.stop();
  if (real) end_ = observed_end(session, rig, at_rest);
  return run;
}

}  // namespace crane::experiments
