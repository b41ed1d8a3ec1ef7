#include "cli/fleet.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ranges>
#include <sstream>

#include "cli/processor_time.hpp"
#include "experiments/realtime_session.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

constexpr std::int64_t kBetweenRequests_ns = 1'000'000'000;
constexpr std::int64_t kBetweenMoves_ns = 6'000'000'000;  // longer than a move through 40 % of the range

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> found;
  std::error_code ignored;
  const auto tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& thread : std::filesystem::directory_iterator{tasks, ignored}) {
    std::ifstream file{thread.path() / "children"};
    for (pid_t child = 0; file >> child;) found.push_back(child);
  }
  return found;
}

double memory_mb(pid_t process) {
  std::ifstream file{"/proc/" + std::to_string(process) + "/smaps_rollup"};
  for (std::string line; std::getline(file, line);) {
    std::istringstream words{line};
    std::string key;
    double kilobytes = 0;
    if (words >> key >> kilobytes && key == "Pss:") return kilobytes / 1024;
  }
  return 0;
}

/// True for a component of the loop: its executable is not `crane`, which runs `crane up` and the black box.
bool in_loop(pid_t process) {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/" + std::to_string(process) + "/exe", ignored).filename() !=
         "crane";
}

}  // namespace

CraneUse use_of(pid_t crane_up) {
  CraneUse use;
  auto processes = children_of(crane_up);
  processes.push_back(crane_up);
  for (const pid_t process : processes) {
    const auto time = time_of_process(process);
    (in_loop(process) ? use.loop_ns : use.other_ns) += time.loop.running_ns + time.others.running_ns;
    use.memory_mb += memory_mb(process);
  }
  use.processes = static_cast<int>(processes.size());
  return use;
}

std::uint64_t FleetCrane::lost_ticks() const {
  std::uint64_t most = 0;
  for (const auto& status : statuses | std::views::values)
    most = std::max<std::uint64_t>(most, status.lost_ticks);
  return most;
}

Fleet::Operator::Operator(const runtime::BusOptions& options)
    : bus{runtime::bus_options(options, "crane_bench", crane_SOURCE_OPERATOR, 0)},
      client{bus, "crane_bench", experiments::unique_first_id()},
      supervisor{bus.subscriber(topics::supervisor)} {}

Fleet::Fleet(const runtime::BusOptions& bus, const configuration::Rig& rig)
    : options_{bus},
      bus_{[all = bus]() mutable {
        all.crane += '*';
        return runtime::bus_options(all, "crane_bench", crane_SOURCE_OPERATOR, 0);
      }()},
      statuses_{bus_.subscriber(topics::node)} {
  while (axis_ + 1 < rig.drives.size() && !rig.drives[axis_].present) ++axis_;
  const auto& drive = rig.drives[axis_];
  const double range = drive.high_limit - drive.low_limit;
  targets_ = {drive.low_limit + 0.3 * range, drive.low_limit + 0.7 * range};
}

void Fleet::add(std::string name, pid_t crane_up) {
  auto options = options_;
  options.crane = name;
  operators_.emplace_back(options);
  cranes_.push_back({.name = std::move(name), .pid = crane_up, .started_ns = runtime::monotonic_ns()});
}

void Fleet::poll() {
  const auto now_ns = runtime::monotonic_ns();
  take_statuses(now_ns);
  for (std::size_t i = 0; operates_ && i < cranes_.size(); ++i) operate(operators_[i], cranes_[i], now_ns);
}

FleetCrane* Fleet::owner_of(pid_t process) {
  if (!owners_.contains(process))
    for (std::size_t i = 0; i < cranes_.size(); ++i)
      for (const pid_t child : children_of(cranes_[i].pid)) owners_[child] = i;
  const auto found = owners_.find(process);
  return found == owners_.end() ? nullptr : &cranes_[found->second];
}

void Fleet::take_statuses(std::int64_t now_ns) {
  static const auto specs = stack::simulated_stack();
  while (const auto status = statuses_.take()) {
    auto* crane = owner_of(static_cast<pid_t>(status->pid));
    if (crane == nullptr) continue;
    crane->statuses[status->name] = *status;
    const bool ready = std::ranges::all_of(specs, [crane](const runtime::ComponentSpec& spec) {
      const auto found = crane->statuses.find(std::string{spec.name});
      return found != crane->statuses.end() && found->second.phase == crane_PHASE_READY;
    });
    if (ready && !crane->start_up_s)
      crane->start_up_s = static_cast<double>(now_ns - crane->started_ns) * 1e-9;
  }
}

/// An armed crane refuses reset and arming without effect. A crane that stops after its first move is not
/// reset: its later moves are refused.
void Fleet::operate(Operator& by, FleetCrane& crane, std::int64_t now_ns) const {
  constexpr std::array kInTurn{crane_REQUEST_RESET, crane_REQUEST_ARM, crane_REQUEST_MOVE};
  while (const auto status = by.supervisor.take()) by.next.newest_status = status->header;
  by.client.receive();
  for (const auto id : by.moves_sent)
    if (const auto reply = by.client.take_reply(id, crane_SOURCE_SUPERVISOR); reply && reply->accepted)
      ++crane.moves;
  if (now_ns < by.next_ns) return;
  by.next_ns = now_ns + (crane.moves > 0 ? kBetweenMoves_ns : kBetweenRequests_ns);
  by.next.kind = crane.moves > 0 ? crane_REQUEST_MOVE : kInTurn[by.requests++ % kInTurn.size()];
  const bool moves = by.next.kind == crane_REQUEST_MOVE;
  by.next.selected[axis_] = moves;
  by.next.target[axis_] = moves ? targets_[by.moves_sent.size() % targets_.size()] : 0;
  const auto id = by.client.send(by.next);
  if (moves) by.moves_sent.push_back(id);
}

}  // namespace crane::cli
