#include "running_stack.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>

#include "stack/data_files.hpp"
#include "stack/stack.hpp"

namespace crane::system_test {

using namespace std::chrono_literals;

std::string crane_name() { return "system_test_" + std::to_string(::getpid()); }

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

Observer::Observer(bus::Bus& bus)
    : state_input_{bus.subscriber(topics::state)},
      status_input_{bus.subscriber(topics::supervisor)},
      command_input_{bus.subscriber(topics::command)},
      node_input_{bus.subscriber(topics::node)} {}

void Observer::take() {
  while (const auto sample = state_input_.take()) states_.push_back(*sample);
  bus::SampleInfo info;
  while (const auto sample = status_input_.take(&info)) {
    if (!info.valid) continue;
    statuses_.push_back(*sample);
    status_times_ns_.push_back(info.source_time_ns);
  }
  while (const auto sample = command_input_.take(&info)) {
    if (!info.valid) continue;
    commands_.push_back(*sample);
    command_times_ns_.push_back(info.source_time_ns);
  }
  while (const auto sample = node_input_.take()) nodes_[sample->name] = *sample;
}

void Observer::forget() {
  take();
  states_.clear();
  statuses_.clear();
  commands_.clear();
  status_times_ns_.clear();
  command_times_ns_.clear();
}

stack::LaunchOptions launch_options(std::uint32_t domain, const std::string& rig) {
  stack::LaunchOptions options;
  options.bus.domain = domain;
  options.bus.crane = crane_name();
  options.rig = stack::find_rig(rig).string();
  return options;
}

namespace {
stack::LaunchOptions options_with(stack::LaunchOptions options, const std::string& keys,
                                  const std::string& vendor, bool ledger) {
  options.bus.secure = keys;
  options.bus.vendor = vendor;
  if (!ledger) options.ledger = nullptr;
  return options;
}
}  // namespace

RunningStack::RunningStack(std::uint32_t domain, const std::string& rig, stack::Plant plant,
                           const std::string& keys, const std::string& vendor, bool ledger)
    : RunningStack{options_with(launch_options(domain, rig), keys, vendor, ledger), plant} {}

RunningStack::RunningStack(stack::LaunchOptions options, stack::Plant plant)
    : options_{std::move(options)}, specs_{stack::stack_with(plant)} {
  if (plant == stack::Plant::hardware)
    stack::launch_rig(children_, configuration::load_rig(options_.rig), options_);
  stack::launch(children_, specs_, options_);
  bus_.emplace(runtime::bus_options(options_.bus, "system_test", crane_SOURCE_OPERATOR, 0));
  observer_.emplace(*bus_);
  stack::wait_until_ready(children_, specs_, *bus_, 15s);
  session_.emplace(*bus_, [this] { observer_->take(); });
}

void RunningStack::send(const std::string& component, int signal) const {
  const auto pid = children_.pid_of(component);
  if (!pid) throw std::logic_error(component + " does not run");
  if (::kill(*pid, signal) != 0) throw std::runtime_error("cannot signal " + component);
}

void RunningStack::start_again(const std::string& component, const std::string& rig) {
  while (children_.ended()) {
  }
  auto specs = specs_;
  std::erase_if(specs, [&](const runtime::ComponentSpec& spec) { return spec.name != component; });
  auto options = options_;
  if (!rig.empty()) options.rig = stack::find_rig(rig).string();
  stack::launch(children_, specs, options);
}

bool RunningStack::until(const std::function<bool()>& condition, std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (observer_->take(); !condition(); observer_->take()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    session_->wait(5ms);
  }
  return true;
}

void RunningStack::listen(std::chrono::milliseconds duration) {
  session_->wait(duration);
  observer_->take();
}

}  // namespace crane::system_test
