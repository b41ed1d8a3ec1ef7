#include "trajectory_planner/trajectory_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "crane/control/controlled_stop.hpp"
#include "crane/control/reference_start.hpp"
#include "crane/runtime/convert.hpp"
#include "trajectory_planner/accepted_move.hpp"
#include "trajectory_planner/motion.hpp"
#include "trajectory_planner/plan_worker.hpp"
#include "trajectory_planner/zone_paths.hpp"

namespace crane::services {
namespace {

using runtime::Context;
/// Longest wait for the inputs of a tick, share of the period; long, because the next tick uses the
/// reference.
constexpr double kWaitShare = 0.8;

/// States in which the brakes are open and the axes follow the reference.
bool follows_reference(crane_SupervisorState state) {
  return state == crane_STATE_HOLD || state == crane_STATE_RUN || state == crane_STATE_STOP_C1;
}

class TrajectoryPlanner : public runtime::JoinedComponent<msg::State, msg::SupervisorStatus> {
 public:
  explicit TrajectoryPlanner(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::supervisor},
        output_{context.ports.output(topics::reference)},
        stale_after_ticks_{context.rig.ticks_in(context.rig.limits.stale_after_s)},
        longest_stop_ticks_{context.rig.ticks_in(control::kControlledStop_s)},
        planning_ticks_{static_cast<std::uint64_t>(
            std::lround(context.rig.planning.planning_time_s / context.rig.period_s))},
        period_s_{context.rig.period_s},
        uses_step_reference_{context.controller.reference == control::ReferenceShape::step},
        rig_{context.rig},
        paths_{context.rig},
        motion_{context.rig, context.controller.reference} {
    if (context.controller.reference == control::ReferenceShape::time_optimal)
      worker_.emplace(context.rig.design, context.clock == runtime::Clock::realtime);
  }

 protected:
  /// Publishes the reference of the present tick when the previous tick did not: at the first tick and after
  /// a gap.
  bool on_idle(std::int64_t /*now_ns*/) override {
    const auto* state = open_leader();
    if (withheld_ || state == nullptr || published_ == state->header.tick) return false;
    if (!published_) motion_.follow(runtime::measurement(*state), state->header.tick);
    publish(*state, state->header.tick);
    return true;
  }

  void on_tick(std::uint64_t tick, const msg::State* state, const msg::SupervisorStatus* status) override {
    missing_statuses_ = status == nullptr ? missing_statuses_ + 1 : 0;
    if (status != nullptr) {
      heard_supervisor_ = true;
      supervisor_ = status->state;
      mode_ = status->mode;
      homing_ = status->homing[0] || status->homing[1] || status->homing[2];
      homing_speed_ = runtime::values(status->homing_speed);
      if (status->header.epoch != supervisor_epoch_) last_seen_move_.reset();
      supervisor_epoch_ = status->header.epoch;
      discard_obsolete_move(status->move);
    }
    if (missing_statuses_ == (stopping_ ? longest_stop_ticks_ : stale_after_ticks_)) lose_supervisor();
    withheld_ = withheld_ && (status == nullptr || follows_reference(status->state));
    if (withheld_) return;
    const auto measured = runtime::measurement(*state);
    const auto next = tick + 1;
    // A planner that starts while the crane is armed begins its reference at the measured position.
    if (!published_) motion_.follow(measured, next);
    if (supervisor_ != crane_STATE_HOLD && supervisor_ != crane_STATE_RUN) drop_waiting_moves();
    if (supervisor_ == crane_STATE_STOP_C1) {
      if (!stopping_) motion_.stop(measured, next);
    } else if (supervisor_ != crane_STATE_HOLD && supervisor_ != crane_STATE_RUN) {
      motion_.follow(measured, next);
    } else if (homing_) {
      motion_.follow_homing_speed(homing_speed_, measured, next);
    } else {
      if (status != nullptr) {
        await_if_new(status->move, next);
        begin_waiting(measured, next);
        start_planned_move(next);
        deflection_ = runtime::values(status->jog_deflection);
      }
      // The deflection belongs to the last session: it releases the stick of a session that ends before it.
      motion_.drive(waiting_ ? plant::PerAxis{} : deflection_, next);
    }
    stopping_ = supervisor_ == crane_STATE_STOP_C1;
    publish(*state, next);
  }
  [[nodiscard]] bool steps_incomplete_ticks() const override { return true; }

 private:
  /// Without the supervisor, the planner knows neither the accepted move nor a stop. It then withholds the
  /// reference: the supervisor stops an armed crane (DEMAND_STALE) and does not arm a stopped one. The
  /// reference returns with a status that shows a stopped crane. In a controlled stop, the planner needs no
  /// status: it continues the reference of the stop. A planner that has heard no supervisor yet follows the
  /// crane.
  void lose_supervisor() {
    withheld_ = heard_supervisor_;
    if (follows_reference(supervisor_))
      node().warning("supervisor_lost",
                     "no status of the supervisor arrives: the reference ends, and the crane stops",
                     "check the connection between the trajectory planner and the supervisor "
                     "(`crane doctor --net`)");
    supervisor_ = crane_STATE_BOOT;
    stopping_ = false;
    last_seen_move_.reset();
  }

  /// Discards a move when the supervisor is not in RUN. The supervisor enters RUN with an accepted move and
  /// leaves RUN when the crane stops or the planner does not begin: a planner that was paused must not
  /// execute the move after the next arming. Moves of unknown age are also obsolete: those of the first
  /// status of a supervisor, and of the first status after a gap.
  void discard_obsolete_move(const msg::AcceptedMove& move) {
    if (last_seen_move_ && (supervisor_ == crane_STATE_RUN || move.number <= *last_seen_move_)) return;
    const bool dropped = last_seen_move_ && move.number > *last_seen_move_;
    last_seen_move_ = move.number;
    if (dropped)
      node().warning("move_obsolete", "an accepted move was not begun in time and will not be executed",
                     "repeat the move");
  }

  /// Takes the last move that the supervisor has accepted. It begins when the reference rests: a motion that
  /// began at the speed of the previous one would pass its own limits of speed and position.
  void await_if_new(const msg::AcceptedMove& move, std::uint64_t tick) {
    if (!last_seen_move_ || move.number <= *last_seen_move_) return;
    last_seen_move_ = move.number;
    drop_waiting_moves();
    if (move.kind == crane_REQUEST_MOVE && !is_inside_limits(rig_, move)) {
      node().error("move_invalid", "the accepted move has a target outside the limits, and is not executed",
                   "another program may have changed the status of the supervisor");
      return;
    }
    constexpr double kLongest_s = 20;  // bounded, because friction may hold an axis away from its reference
    const auto rest = motion_.slow_down(tick);
    waiting_ =
        MoveAwaitingRest{move, rest + static_cast<std::uint64_t>(std::llround(kLongest_s / period_s_))};
  }

  void begin_waiting(const control::Measurement& measured, std::uint64_t tick) {
    if (!waiting_ || !motion_.reference_rests(tick)) return;
    const bool around_zones = waiting_->move.kind == crane_REQUEST_MOVE && paths_.needed();
    // The supervisor has searched a path from the measured position. The accepted path of the previous move
    // connects this position with the resting point; therefore a path from the resting point exists.
    if (around_zones && !motion_.rests(measured, tick) && tick < waiting_->last_tick) return;
    const auto move = waiting_->move;
    waiting_.reset();
    if (around_zones) return start_around_zones(move, tick);
    move_number_ = move.number;
    move_kind_ = move.kind;
    if (move.kind == crane_REQUEST_JOG)
      motion_.jog(target_of(move).selected, tick);
    else if (move.kind == crane_REQUEST_FOLLOW)
      motion_.excite(excitation_of(move), tick);
    else
      start_straight(target_of(move), tick);
  }

  /// In maintenance mode, a shaped profile replaces the time-optimal plan, which would use the full speed of
  /// the drives.
  [[nodiscard]] bool uses_plans() const { return worker_ && mode_ != crane_MODE_MAINTENANCE; }

  /// Starts a move on the straight path.
  void start_straight(const MoveTarget& move, std::uint64_t tick) {
    if (const auto problem = uses_plans() ? motion_.plan_for(move, tick) : std::nullopt)
      pending_ = MoveAwaitingPlan{move, *problem, tick + planning_ticks_, worker_->ask(*problem)};
    else
      motion_.start(move, tick);
  }

  void start_around_zones(const msg::AcceptedMove& accepted, std::uint64_t tick) {
    const MoveTarget move = target_of(accepted);
    const auto now = motion_.at(tick);
    plant::PerAxis from{}, target{};
    for (std::size_t i = 0; i < control::kAxes; ++i) {
      from[i] = now[i].position;
      target[i] = move.selected[i] ? move.target[i] : from[i];
    }
    const auto path = paths_.path(
        from, target, uses_step_reference_ || uses_plans() ? StraightSpeed::full : StraightSpeed::reference);
    const bool has_path =
        path.outcome == control::PathOutcome::straight || path.outcome == control::PathOutcome::by_waypoints;
    if (has_path) move_number_ = accepted.number, move_kind_ = accepted.kind;
    if (path.outcome == control::PathOutcome::straight)
      start_straight(move, tick);
    else if (path.outcome == control::PathOutcome::by_waypoints)
      motion_.start(path, paths_.space(), tick);
    else
      node().error("no_path", "no path leads from the place where the crane rests to the target",
                   "move the load away from the zones, then to the target");
  }

  void drop_waiting_moves() {
    pending_.reset();
    waiting_.reset();
  }

  /// Begins the move that waits for its plan: with the plan, or with a shaped profile when the plan is late.
  void start_planned_move(std::uint64_t tick) {
    if (!pending_) return;
    if (!pending_->submitted) pending_->submitted = worker_->ask(pending_->problem);
    if (tick < pending_->begin_tick) return;
    const auto result = pending_->submitted ? worker_->take() : std::nullopt;
    if (result && result->outcome == control::PlanOutcome::solved)
      motion_.start(pending_->problem, result->plan, tick);
    else
      motion_.start(pending_->target, tick);
    pending_.reset();
  }

  void publish(const msg::State& state, std::uint64_t tick) {
    msg::Reference sample{};
    sample.header = runtime::answer_to(state.header);
    sample.header.tick = tick;
    const auto measured = runtime::measurement(state);
    auto reference = motion_.at(tick);
    start_.set_starts(measured, reference);
    runtime::assign(sample, reference);
    sample.move_number = move_number_;
    sample.second_writer = disputed();
    sample.configuration = configuration();
    if (motion_.arrived(measured, tick)) ended_motion_ = motion_.start_tick();
    sample.moving = pending_ || waiting_ || ended_motion_ != motion_.start_tick();
    if (moving_ && !sample.moving && move_kind_ == crane_REQUEST_MOVE && follows_reference(supervisor_) &&
        !motion_.is_near(measured, tick))
      node().warning("target_not_reached", "the move has ended, but an axis is away from its target",
                     "the reason may be friction, wind or the offset of a swing sensor; `crane status` shows "
                     "the positions");
    moving_ = sample.moving;
    output_.publish(sample);
    published_ = tick;
  }

  runtime::Output<msg::Reference> output_;
  int stale_after_ticks_, longest_stop_ticks_;
  /// A move that waits for its plan.
  struct MoveAwaitingPlan {
    MoveTarget target;
    control::PlanProblem problem;
    std::uint64_t begin_tick;
    bool submitted;
  };
  std::uint64_t planning_ticks_;
  std::optional<PlanWorker> worker_;  ///< only for controllers with time-optimal references
  std::optional<MoveAwaitingPlan> pending_;
  /// A move that waits until the reference, and with zones also the crane, rests.
  struct MoveAwaitingRest {
    msg::AcceptedMove move;
    std::uint64_t last_tick;  ///< until which the move waits for the crane
  };
  std::optional<MoveAwaitingRest> waiting_;
  double period_s_;
  bool uses_step_reference_;  ///< true: the controller uses step references
  const configuration::Rig& rig_;
  ZonePaths paths_;
  Motion motion_;
  control::ReferenceStart start_;
  std::optional<std::uint64_t> published_;
  /// Tick at which the last completed motion began. A crane that leaves its target afterwards, by a push or
  /// because its load swings, does not begin this motion again.
  std::optional<std::uint64_t> ended_motion_;
  crane_SupervisorState supervisor_ = crane_STATE_BOOT;
  crane_OperatingMode mode_ = crane_MODE_SEMI_AUTOMATIC;
  std::array<double, control::kAxes> homing_speed_{}, deflection_{};
  bool homing_ = false;
  int missing_statuses_ = 0;
  bool withheld_ = false;                             ///< true: no reference is published
  bool moving_ = false;                               ///< Reference.moving of the last reference
  crane_RequestKind move_kind_ = crane_REQUEST_MOVE;  ///< of the move that is executed
  bool stopping_ = false, heard_supervisor_ = false;
  std::uint32_t supervisor_epoch_ = 0;           ///< start-up number of the supervisor that counts the moves
  std::optional<std::uint64_t> last_seen_move_;  ///< number of the last move that is executed or obsolete
  std::uint64_t move_number_ = 0;                ///< number of the move that the reference executes
};

}  // namespace

runtime::ComponentSpec trajectory_planner_spec() {
  return {
      .name = "trajectory_planner",
      .program = "crane_trajectory_planner",
      .summary = "Trajectory planner: reference of moves, paths around zones, excitations, stick and homing.",
      .source = crane_SOURCE_PLANNER,
      .runs_controller = true,
      .reads = {{&topics::state.description, "positions of the axes at the start of a move"},
                {&topics::supervisor.description,
                 "safety state, the move that was accepted, and the checked deflection of the stick"}},
      .writes = {{&topics::reference.description, "reference of each axis for the next tick"}},
      .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
        return std::make_unique<TrajectoryPlanner>(context);
      }};
}

}  // namespace crane::services
