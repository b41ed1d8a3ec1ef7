#include "cli/processor_time.hpp"

#include <filesystem>
#include <fstream>

namespace crane::cli {
namespace {

ThreadShare share_of(const ThreadTime& begin, const ThreadTime& end, double ticks) {
  const auto per_tick = [ticks](std::int64_t from, std::int64_t to) {
    return static_cast<double>(to - from) / ticks;
  };
  return {.running_us = per_tick(begin.running_ns, end.running_ns) / 1e3,
          .waiting_us = per_tick(begin.waiting_ns, end.waiting_ns) / 1e3,
          .runs = per_tick(begin.runs, end.runs)};
}

}  // namespace

ProcessTime time_of_process(pid_t pid) {
  ProcessTime time;
  for (const auto& thread : std::filesystem::directory_iterator{"/proc/" + std::to_string(pid) + "/task"}) {
    ThreadTime spent;
    std::ifstream{thread.path() / "schedstat"} >> spent.running_ns >> spent.waiting_ns >> spent.runs;
    auto& sum = thread.path().filename() == std::to_string(pid) ? time.loop : time.others;
    sum.running_ns += spent.running_ns;
    sum.waiting_ns += spent.waiting_ns;
    sum.runs += spent.runs;
  }
  return time;
}

ProcessorTimes::ProcessorTimes(const stack::ChildProcesses& children,
                               const std::vector<runtime::ComponentSpec>& specs) {
  for (const auto& spec : specs) {
    const auto pid = children.pid_of(std::string{spec.name}).value();
    measured_.push_back({std::string{spec.name}, pid, time_of_process(pid)});
  }
}

std::vector<ProcessShare> ProcessorTimes::per_tick(double ticks) const {
  std::vector<ProcessShare> shares;
  for (const auto& [process, pid, begin] : measured_) {
    const auto now = time_of_process(pid);
    shares.push_back(
        {process, share_of(begin.loop, now.loop, ticks), share_of(begin.others, now.others, ticks)});
  }
  return shares;
}

}  // namespace crane::cli
