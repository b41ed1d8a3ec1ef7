/// Cranes without any fault: whatever stops one is a false trip.
#include <algorithm>
#include <cstdio>

#include "campaign/campaign.hpp"
#include "campaign/judge/truth.hpp"
#include "campaign/report.hpp"
#include "crane/workers/process_pool.hpp"

namespace crane::campaign {
namespace {

constexpr double kPause_s = 0.5, kLongestMove_s = 40, kShare_s = 900;  // of one crane, before it starts anew

/// Anywhere that an operator may ask for, on any axes.
stack::Wish random_move(const Setting& setting, Dice& dice) {
  stack::Wish wish{.kind = crane_REQUEST_MOVE};
  bool any = false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = setting.told.drives[i];
    wish.selected[i] = drive.present && (dice.pick(2) == 0 || i == setting.axis);
    any = any || wish.selected[i];
    wish.target[i] =
        dice.between(drive.low_limit + drive.soft_margin + 1e-6, drive.high_limit - drive.soft_margin - 1e-6);
  }
  return wish;
}

/// Stopped, and not by its operator.
bool has_tripped(const Row& row) {
  const bool stopped = row.status.state >= crane_STATE_STOP_C1 || row.status.state == crane_STATE_LOCKED;
  return stopped && row.status.cause != crane_CAUSE_OPERATOR_STOP &&
         row.status.cause != crane_CAUSE_OPERATOR_DISARM;
}

/// An axis went farther than `way` since the row `since`.
bool has_moved(const Setting& setting, const std::vector<Row>& rows, std::size_t since, std::size_t at,
               const std::function<double(std::size_t)>& way) {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (setting.told.drives[i].present &&
        std::abs(rows[at].truth.position[i] - rows[since].truth.position[i]) > way(i))
      return true;
  return false;
}

/// The stop has lasted too long, and an axis still moves: within the tenth of a second that counts as
/// standstill it has gone farther than half a count.
bool stops_without_rest(const Setting& setting, const std::vector<Row>& rows, std::size_t at) {
  constexpr std::size_t kStandstill_ticks = 10;
  return at >= kStandstill_ticks && has_moved(setting, rows, at - kStandstill_ticks, at, [&](std::size_t i) {
           return 0.5 / setting.told.encoders[i].counts_per_unit;
         });
}

/// A swinging load pulls an axis away while its brake opens.
bool moves_while_arming(const Setting& setting, const std::vector<Row>& rows, std::size_t at) {
  std::size_t since = at;
  while (since > 0 && rows[since - 1].status.state == crane_STATE_ARMING) --since;
  return since < at && has_moved(setting, rows, since, at, [&](std::size_t i) {
           return setting.told.drives[i].brake_slip - 1 / setting.told.encoders[i].counts_per_unit;
         });
}

/// The reason of the stop is true in the row in which the crane was stopped.
bool is_confirmed(const Reason& reason, const Setting& setting, const std::vector<Row>& rows) {
  const auto found = std::ranges::find_if(rows, has_tripped);
  if (found == rows.end()) return false;
  const auto at = static_cast<std::size_t>(found - rows.begin());
  if (reason.cause == crane_CAUSE_STOP_TIMEOUT) return stops_without_rest(setting, rows, at);
  if (reason.cause == crane_CAUSE_STOPPING_ENVELOPE && moves_while_arming(setting, rows, at)) return true;
  return is_true(reason, setting.told, rows, at);
}

/// One crane at work, from power-on until it trips or its share is over.
class Stretch {
 public:
  Stretch(std::uint64_t number, Dice& dice) : bench_{setting(number, Moment::armed_idle)}, dice_{dice} {}

  void run() {
    if (!bench_.prepare(Moment::armed_idle)) return fail("never armed");
    (void)bench_.take_rows();  // LOCKED after power-on is no trip
    while (seconds_ < kShare_s && trip_.empty()) {
      operate();
      const auto rows = bench_.take_rows();
      seconds_ += static_cast<double>(rows.size()) * bench_.setting().told.period_s;
      if (!has_tripped(bench_.now())) continue;
      const Reason reason{bench_.now().status.cause, bench_.now().state.latch_reason};
      confirmed_ = is_confirmed(reason, bench_.setting(), rows);
      fail(to_string(reason));
    }
  }
  /// "812.4 1 gain_scheduling_partial on gantry, ...": seconds, whether the truth confirms the reason, the
  /// trip.
  [[nodiscard]] std::string line() const {
    return std::to_string(seconds_) + (confirmed_ ? " 1 " : " 0 ") + trip_ + "\n";
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  /// A move to its end, or a new one on the way, or a stop on the way.
  void operate() {
    bench_.ask(random_move(bench_.setting(), dice_));
    bench_.run(kPause_s);
    const auto rests = [this] { return bench_.now().status.state != crane_STATE_RUN; };
    const bool interrupted = dice_.chance(kInterrupted);
    bench_.run_until(rests, interrupted ? dice_.between(0, kLongestInterrupted_s) : kLongestMove_s);
    if (interrupted && dice_.chance(kStopped) && !has_tripped(bench_.now())) stop_and_arm();
  }
  void stop_and_arm() {
    bench_.ask(dice_.pick(2) == 0 ? crane_REQUEST_STOP : crane_REQUEST_DISARM);
    bench_.run_until(
        [this] { return bench_.now().status.state == crane_STATE_LOCKED || has_tripped(bench_.now()); },
        kLongestMove_s);
    if (has_tripped(bench_.now())) return;
    bench_.run(kClear_s);
    bench_.ask(crane_REQUEST_RESET);
    bench_.run(kClear_s);
    bench_.ask(crane_REQUEST_ARM);
    const auto holds = [this] { return bench_.now().status.state == crane_STATE_HOLD; };
    if (!bench_.run_until(holds, kLongestMove_s) && !has_tripped(bench_.now())) fail("not armed again");
  }
  void fail(const std::string& reason) {
    trip_ = std::string{bench_.setting().controller->name} + " on " + bench_.setting().told.name +
            ", after " + std::to_string(seconds_) + " s: " + reason;
    if (trip_.ends_with('\n')) trip_.pop_back();
  }

  static constexpr double kInterrupted = 0.3, kStopped = 0.5, kLongestInterrupted_s = 4;
  Bench bench_;
  Dice& dice_;
  double seconds_ = 0;
  bool confirmed_ = false;  ///< by the truth
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
                        Dice dice{seed * 1'000'003 + number};
                        Stretch stretch{number % kSettings, dice};
                        stretch.run();
                        left_s -= std::max(stretch.seconds(), 1.0);
                        outbox.send(stretch.line());
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
