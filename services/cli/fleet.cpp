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

/// The components have programs of their own. `crane up` and the black box are the program `crane`.
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

Fleet::Fleet(runtime::BusOptions bus, const configuration::Rig& rig)
    : bus_{[&bus] {
        bus.crane += '*';
        return runtime::bus_options(bus, "crane_bench", crane_SOURCE_OPERATOR, 0);
      }()},
      statuses_{bus_.subscriber(topics::node)},
      operator_{bus_, "crane_bench", experiments::unique_first_id()} {
  while (axis_ + 1 < rig.drives.size() && !rig.drives[axis_].present) ++axis_;
  const auto& drive = rig.drives[axis_];
  const double range = drive.high_limit - drive.low_limit;
  targets_ = {drive.low_limit + 0.3 * range, drive.low_limit + 0.7 * range};
}

void Fleet::add(std::string name, pid_t crane_up) {
  cranes_.push_back({.name = std::move(name), .pid = crane_up, .started_ns = runtime::monotonic_ns()});
}

void Fleet::poll() {
  const auto now_ns = runtime::monotonic_ns();
  take_statuses(now_ns);
  take_replies();
  if (operates_ && now_ns >= next_ns_) send_next(now_ns);
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

FleetCrane* Fleet::crane_of_supervisor(std::uint32_t epoch) {
  const auto found = std::ranges::find_if(cranes_, [epoch](const FleetCrane& crane) {
    const auto status = crane.statuses.find("supervisor");
    return status != crane.statuses.end() && status->second.header.epoch == epoch;
  });
  return found == cranes_.end() ? nullptr : &*found;
}

void Fleet::take_replies() {
  operator_.receive();
  for (const auto id : moves_sent_)
    while (const auto reply = operator_.take_reply(id, crane_SOURCE_SUPERVISOR))
      if (auto* crane = crane_of_supervisor(reply->header.epoch); crane != nullptr && reply->accepted)
        ++crane->moves;
}

/// Until every crane has accepted a move: reset, arm, move in turn; a crane that is armed already refuses the
/// reset and the arming. Afterwards only moves: a crane that has stopped stays stopped and accepts none.
void Fleet::send_next(std::int64_t now_ns) {
  const bool all_move = std::ranges::all_of(cranes_, [](const FleetCrane& crane) { return crane.moves > 0; });
  const std::array kinds{crane_REQUEST_RESET, crane_REQUEST_ARM, crane_REQUEST_MOVE};
  stack::OperatorRequest request;
  request.kind = all_move ? crane_REQUEST_MOVE : kinds[requests_++ % kinds.size()];
  next_ns_ = now_ns + (all_move ? kBetweenMoves_ns : kBetweenRequests_ns);
  if (request.kind != crane_REQUEST_MOVE) {
    (void)operator_.send(request);
    return;
  }
  request.selected[axis_] = true;
  request.target[axis_] = targets_[moves_sent_.size() % targets_.size()];
  moves_sent_.push_back(operator_.send(request));
}

}  // namespace crane::cli
