/// Cranes without faults: every stop that no operator requested is a false trip, unless the true state
/// confirms it.
#include <algorithm>
#include <cstdio>

#include "campaign/campaign.hpp"
#include "campaign/judge/truth.hpp"
#include "campaign/report.hpp"
#include "crane/workers/process_pool.hpp"

namespace crane::campaign {
namespace {

constexpr double kPause_s = 0.5, kLongestMove_s = 40, kShare_s = 900;  // longest time of one crane

/// A move to any permitted target on any axes.
stack::OperatorRequest random_move(const Setting& setting, Random& random) {
  stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
  bool any = false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = setting.configured.drives[i];
    wanted.selected[i] = drive.present && (random.pick(2) == 0 || i == setting.axis);
    any = any || wanted.selected[i];
    wanted.target[i] = random.between(drive.low_limit + drive.soft_margin + 1e-6,
                                      drive.high_limit - drive.soft_margin - 1e-6);
  }
  return wanted;
}

/// True when the crane was stopped, and not by its operator.
bool has_tripped(const Row& row) {
  const bool stopped = row.status.state >= crane_STATE_STOP_C1 || row.status.state == crane_STATE_LOCKED;
  return stopped && row.status.cause != crane_CAUSE_OPERATOR_STOP &&
         row.status.cause != crane_CAUSE_OPERATOR_DISARM;
}

/// True when an axis moved by more than `distance(axis)`, m or rad, from row `since` to row `at`.
bool has_moved(const Setting& setting, const std::vector<Row>& rows, std::size_t since, std::size_t at,
               const std::function<double(std::size_t)>& distance) {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (setting.configured.drives[i].present &&
        std::abs(rows[at].truth.position[i] - rows[since].truth.position[i]) > distance(i))
      return true;
  return false;
}

/// True when a controlled stop took too long because an axis did not come to rest: the axis moved by more
/// than half a count within the 0.1 s that define standstill.
bool stops_without_rest(const Setting& setting, const std::vector<Row>& rows, std::size_t at) {
  constexpr std::size_t kStandstill_ticks = 10;
  return at >= kStandstill_ticks && has_moved(setting, rows, at - kStandstill_ticks, at, [&](std::size_t i) {
           return 0.5 / setting.configured.encoders[i].counts_per_unit;
         });
}

/// True when the force of a swinging load moved an axis while its brake opened.
bool moves_while_arming(const Setting& setting, const std::vector<Row>& rows, std::size_t at) {
  std::size_t since = at;
  while (since > 0 && rows[since - 1].status.state == crane_STATE_ARMING) --since;
  return since < at && has_moved(setting, rows, since, at, [&](std::size_t i) {
           return setting.configured.drives[i].brake_slip -
                  1 / setting.configured.encoders[i].counts_per_unit;
         });
}

/// True when the true state confirms the reason of the stop.
bool is_confirmed(const Reason& reason, const Setting& setting, const std::vector<Row>& rows) {
  const auto found = std::ranges::find_if(rows, has_tripped);
  if (found == rows.end()) return false;
  const auto at = static_cast<std::size_t>(found - rows.begin());
  if (reason.cause == crane_CAUSE_STOP_TIMEOUT) return stops_without_rest(setting, rows, at);
  if (reason.cause == crane_CAUSE_STOPPING_ENVELOPE && moves_while_arming(setting, rows, at)) return true;
  return is_true(reason, setting.configured, rows, at);
}

/// One crane from power-on until it trips or its time is over.
class FaultFreeRun {
 public:
  FaultFreeRun(std::uint64_t number, Random& random)
      : bench_{setting(number, Moment::armed_idle)}, random_{random} {}

  void run() {
    if (!bench_.prepare(Moment::armed_idle)) return fail("never armed");
    (void)bench_.take_rows();  // the state LOCKED after power-on is not a trip
    while (seconds_ < kShare_s && trip_.empty()) {
      operate();
      const auto rows = bench_.take_rows();
      seconds_ += static_cast<double>(rows.size()) * bench_.setting().configured.period_s;
      if (!has_tripped(bench_.now())) continue;
      const Reason reason{bench_.now().status.cause, bench_.now().state.latch_reason};
      confirmed_ = is_confirmed(reason, bench_.setting(), rows);
      fail(to_string(reason));
    }
  }
  /// "812.4 1 gain_scheduling_partial on gantry, ...": virtual time in s; 1 when the true state confirms the
  /// reason, else 0; description of the trip.
  [[nodiscard]] std::string line() const {
    return std::to_string(seconds_) + (confirmed_ ? " 1 " : " 0 ") + trip_ + "\n";
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  /// Executes a move, or interrupts it by another move or a stop.
  void operate() {
    bench_.request(random_move(bench_.setting(), random_));
    bench_.run(kPause_s);
    const auto rests = [this] { return bench_.now().status.state != crane_STATE_RUN; };
    const bool interrupted = random_.chance(kInterrupted);
    bench_.run_until(rests, interrupted ? random_.between(0, kLongestInterrupted_s) : kLongestMove_s);
    if (interrupted && random_.chance(kStopped) && !has_tripped(bench_.now())) stop_and_arm();
  }
  void stop_and_arm() {
    bench_.request(random_.pick(2) == 0 ? crane_REQUEST_STOP : crane_REQUEST_DISARM);
    bench_.run_until(
        [this] { return bench_.now().status.state == crane_STATE_LOCKED || has_tripped(bench_.now()); },
        kLongestMove_s);
    if (has_tripped(bench_.now())) return;
    bench_.run(kClear_s);
    bench_.request(crane_REQUEST_RESET);
    bench_.run(kClear_s);
    bench_.request(crane_REQUEST_ARM);
    const auto holds = [this] { return bench_.now().status.state == crane_STATE_HOLD; };
    if (!bench_.run_until(holds, kLongestMove_s) && !has_tripped(bench_.now())) fail("not armed again");
  }
  void fail(const std::string& reason) {
    trip_ = std::string{bench_.setting().controller->name} + " on " + bench_.setting().configured.name +
            ", after " + std::to_string(seconds_) + " s: " + reason;
    if (trip_.ends_with('\n')) trip_.pop_back();
  }

  static constexpr double kInterrupted = 0.3, kStopped = 0.5, kLongestInterrupted_s = 4;
  Bench bench_;
  Random& random_;
  double seconds_ = 0;
  bool confirmed_ = false;  ///< true: the true state confirms the reason
  std::string trip_;
};

}  // namespace

FaultFree run_fault_free(double hours, unsigned jobs, std::uint64_t seed) {
  FaultFree found;
  workers::run({.count = jobs,
                .at_a_time = jobs,
                .work =
                    [&](std::size_t worker, const workers::Outbox& outbox) {
                      double left_s = hours * 3600 / jobs;
                      for (std::uint64_t number = worker; left_s > 0; number += jobs) {
                        Random random{seed * 1'000'003 + number};
                        FaultFreeRun run{number % kSettings, random};
                        run.run();
                        left_s -= std::max(run.seconds(), 1.0);
                        outbox.send(run.line());
                      }
                    },
                .take =
                    [&](std::size_t, const std::string& line) {
                      double seconds = 0;
                      int length = 0, confirmed = 0;
                      if (std::sscanf(line.c_str(), "%lf %d %n", &seconds, &confirmed, &length) < 2) return;
                      found.hours += seconds / 3600;
                      const auto at = static_cast<std::size_t>(length);
                      if (at < line.size() && line[at] != '\n')
                        (confirmed != 0 ? found.limits : found.trips).push_back(line.substr(at));
                    },
                .ended = workers::require_success});
  return found;
}

}  // namespace crane::campaign
