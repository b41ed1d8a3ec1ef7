/// Cranes without any fault: whatever stops one is a false trip.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "campaign/campaign.hpp"
#include "campaign/judge/truth.hpp"
#include "campaign/report.hpp"

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

struct Stretch {
  double seconds = 0;
  std::string trip;
  bool confirmed = false;  ///< by the truth
};

/// The reason of the stop is true in the row in which the crane was stopped.
bool is_confirmed(const Reason& reason, const Setting& setting, const std::vector<Row>& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k].status.state >= crane_STATE_STOP_C1 || rows[k].status.state == crane_STATE_LOCKED)
      return is_true(reason, setting.told, rows, k);
  return false;
}

/// One crane, from power-on until it trips or its share is over.
Stretch run_stretch(std::uint64_t number, Dice& dice) {
  Bench bench{setting(number, Moment::armed_idle)};
  Stretch stretch;
  if (!bench.prepare(Moment::armed_idle)) return {.trip = "never armed"};
  const double period_s = bench.setting().told.period_s;
  const auto stopped = [&bench] {
    return bench.now().status.state >= crane_STATE_STOP_C1 || bench.now().status.state == crane_STATE_LOCKED;
  };
  std::vector<Row> rows;
  while (stretch.seconds < kShare_s && !stopped()) {
    bench.ask(random_move(bench.setting(), dice));
    bench.run(kPause_s);
    bench.run_until([&] { return bench.now().status.state != crane_STATE_RUN; }, kLongestMove_s);
    rows = bench.take_rows();
    stretch.seconds += static_cast<double>(rows.size()) * period_s;
  }
  if (stopped()) {
    const Reason reason{bench.now().status.cause, bench.now().state.latch_reason};
    stretch.confirmed = is_confirmed(reason, bench.setting(), rows);
    stretch.trip = std::string{bench.setting().controller->name} + " on " + bench.setting().told.name +
                   ", after " + std::to_string(stretch.seconds) + " s: " + to_string(reason);
  }
  return stretch;
}

}  // namespace

FaultFree run_fault_free(double hours, unsigned jobs, std::uint64_t seed) {
  std::FILE* lines = std::tmpfile();
  if (lines == nullptr) throw std::system_error(errno, std::generic_category(), "tmpfile");
  std::vector<pid_t> workers;
  for (unsigned worker = 0; worker < jobs; ++worker) {
    const pid_t pid = ::fork();
    if (pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (pid > 0) {
      workers.push_back(pid);
      continue;
    }
    double left_s = hours * 3600 / jobs;
    for (std::uint64_t number = worker; left_s > 0; number += jobs) {
      Dice dice{seed * 1'000'003 + number};
      const auto stretch = run_stretch(number % kSettings, dice);
      left_s -= std::max(stretch.seconds, 1.0);
      const auto line =
          std::to_string(stretch.seconds) + (stretch.confirmed ? " 1 " : " 0 ") + stretch.trip + "\n";
      if (::write(::fileno(lines), line.data(), line.size()) < 0) ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t pid : workers) ::waitpid(pid, nullptr, 0);
  std::rewind(lines);
  FaultFree found;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), lines) != nullptr) {
    double seconds = 0;
    int length = 0, confirmed = 0;
    if (std::sscanf(line.data(), "%lf %d %n", &seconds, &confirmed, &length) < 2) continue;
    found.hours += seconds / 3600;
    if (line[static_cast<std::size_t>(length)] != '\0' && line[static_cast<std::size_t>(length)] != '\n')
      (confirmed != 0 ? found.limits : found.trips).emplace_back(line.data() + length);
  }
  std::fclose(lines);
  return found;
}

}  // namespace crane::campaign
