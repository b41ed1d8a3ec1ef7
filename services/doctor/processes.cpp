#include "doctor/processes.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <map>
#include <utility>

namespace crane::doctor {
namespace {

namespace fs = std::filesystem;

constexpr std::array kLoop{
    "crane_plant",      "crane_hardware_bridge",       "crane_trajectory_planner", "crane_tracking",
    "crane_anti_swing", "crane_friction_compensation", "crane_supervisor",         "crane_loop"};

std::vector<std::string> arguments_of(const fs::path& process) {
  std::ifstream file{process / "cmdline", std::ios::binary};
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

/// State of the process: the letter after the name. The name is in parentheses and may contain any
/// characters.
char state_of(const fs::path& process) {
  std::ifstream file{process / "stat"};
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(')');
  return end != std::string::npos && end + 2 < text.size() ? text[end + 2] : '?';
}

int number_of(const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? number : 0;
}

fs::path link_of(const fs::path& link) {
  std::error_code ignored;
  return fs::read_symlink(link, ignored);
}

}  // namespace

bool LocalProcess::in_loop() const { return std::ranges::find(kLoop, program) != kLoop.end(); }

LocalProcess process_from(const std::vector<std::string>& arguments) {
  LocalProcess process;
  if (arguments.empty()) return process;
  process.program = fs::path{arguments.front()}.filename();
  bool first_interface = true;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const auto equals = arguments[i].find('=');
    const auto name = arguments[i].substr(0, equals);
    const bool joined = equals != std::string::npos;
    if (!joined && i + 1 == arguments.size()) break;
    const auto value = joined ? arguments[i].substr(equals + 1) : arguments[i + 1];
    if (name == "--crane") process.crane = value;
    if (name == "--domain") process.domain = static_cast<std::uint32_t>(std::max(0, number_of(value)));
    if (name == "--secure") process.secure = true;
    if (name != "--interface") continue;
    if (std::exchange(first_interface, false)) process.interfaces.clear();
    process.interfaces.push_back(value);
  }
  return process;
}

std::vector<LocalProcess> local_processes(const fs::path& proc) {
  const auto own_network = link_of(proc / "self/ns/net");
  std::vector<LocalProcess> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{proc, ignored}) {
    const int pid = number_of(entry.path().filename());
    if (pid <= 0 || pid == ::getpid()) continue;
    auto process = process_from(arguments_of(entry.path()));
    if (process.program != "crane" && !process.program.starts_with("crane_")) continue;
    if (link_of(entry.path() / "ns/net") != own_network) continue;
    process.pid = pid;
    const char state = state_of(entry.path());
    process.stopped = state == 'T' || state == 't';
    found.push_back(std::move(process));
  }
  return found;
}

namespace {

Finding stopped(const LocalProcess& process) {
  const auto pid = std::to_string(process.pid);
  return {Grade::problem, "net", "process_stopped",
          process.program + " (process " + pid + ") is stopped and does not answer",
          "continue it with `kill -CONT " + pid + "`, or end it with `kill -KILL " + pid + "`"};
}

Finding runs_twice(const std::string& program, const std::vector<int>& pids, const std::string& crane,
                   std::uint32_t domain) {
  std::string all;
  for (const int pid : pids) all.append(all.empty() ? "" : " and ").append(std::to_string(pid));
  return {Grade::problem, "net", "process_twice",
          program + " runs " + (pids.size() == 2 ? "twice" : std::to_string(pids.size()) + " times") +
              " for crane '" + crane + "' in domain " + std::to_string(domain) + ": processes " + all,
          "end the process of the earlier stack with `kill PID`"};
}

}  // namespace

Findings judge_processes(const std::vector<LocalProcess>& processes, const std::string& crane,
                         std::uint32_t domain) {
  Findings findings;
  std::map<std::string, std::vector<int>> by_program;
  for (const auto& process : processes) {
    if (!process.in_loop() || process.crane != crane || process.domain != domain) continue;
    by_program[process.program].push_back(process.pid);
    if (process.stopped) findings.push_back(stopped(process));
  }
  for (const auto& [program, pids] : by_program)
    if (pids.size() > 1) findings.push_back(runs_twice(program, pids, crane, domain));
  return findings;
}

}  // namespace crane::doctor
