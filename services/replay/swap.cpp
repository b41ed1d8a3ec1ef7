#include "replay/swap.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "crane/plant/coordinates.hpp"
#include "crane/runtime/process.hpp"
#include "crane/supervisor/component.hpp"
#include "replay/replay.hpp"
#include "replay/replayed_stack.hpp"

namespace crane::replay {
namespace {

std::optional<msg::Demand> demand_of(const Cdr* cdr) {
  return cdr == nullptr ? std::nullopt : decoded(topics::demand, *cdr);
}

/// The components that compute the demand, without the supervisor: it would compare the recorded motion with
/// the commands of the other controller, which did not cause this motion.
std::vector<runtime::ComponentSpec> demanding_components() {
  auto components = loop_components();
  std::erase_if(components, [](const auto& component) {
    return component.source == supervisor::supervisor_spec().source;
  });
  return components;
}

recording::Table empty_table() {
  recording::Table table;
  table.columns.push_back({"time_s", {}});
  table.columns.push_back({"tick", {}});
  for (const auto& axis : plant::drive_names())
    for (const auto* who : {"recorded", "other"}) table.columns.push_back({axis + "_" + who + "_v", {}});
  return table;
}

class Swap {
 public:
  Swap(RecordedRun& run, const control::Controller& other)
      : run_{run}, stack_{demanding_components(), run.rig(), other} {
    result_.recorded = run.controller().name;
    result_.other = other.name;
    result_.table = empty_table();
  }

  SwapResult make() {
    run_.for_each([this](const RecordedTick& tick) { return add(tick); });
    if (result_.ticks == 0) throw Refusal("the recording does not begin with a complete tick 0");
    std::ranges::copy(run_.problems(), std::back_inserter(result_.problems));
    return std::move(result_);
  }

 private:
  bool add(const RecordedTick& tick) {
    if (tick.assumed) return true;  // without the recorded status of the supervisor
    if (!tick.ends.empty())
      result_.problems.push_back("tick " + std::to_string(tick.number) + ": " + tick.ends);
    if (tick.begins) begin_ = tick.number;
    const bool follows = tick.number == begin_ + run_.assumed_ticks() + result_.ticks;
    if (!tick.ends.empty() || !follows || !stack_.receive(tick)) return false;
    const auto recorded = demand_of(tick.find(topics::demand.description));
    const auto other = demand_of(stack_.find(topics::demand.description, tick.number));
    if (!recorded || !other) return false;
    note(*recorded, *other);
    stack_.forget_until(tick.number);
    ++result_.ticks;
    return true;
  }

  void note(const msg::Demand& recorded, const msg::Demand& other) {
    const auto tick = recorded.header.tick;
    const double time_s = static_cast<double>(recorded.header.sample_time_ns) / 1e9;
    auto column = result_.table.columns.begin();
    (column++)->values.push_back(time_s);
    (column++)->values.push_back(static_cast<double>(tick));
    for (std::size_t i = 0; i < plant::kAxes; ++i) {
      const double was_v = recorded.total_v[i], would_v = other.total_v[i];
      (column++)->values.push_back(was_v);
      (column++)->values.push_back(would_v);
      if (!result_.first_differs && std::memcmp(&was_v, &would_v, sizeof was_v) != 0)
        result_.first_differs = tick;
      const double difference_v = std::abs(would_v - was_v);
      if (difference_v > result_.largest[i].difference_v)
        result_.largest[i] = {difference_v, was_v, would_v, tick, time_s};
    }
  }

  RecordedRun& run_;
  InProcessReplay stack_;
  SwapResult result_;
  std::uint64_t begin_ = 0;  ///< first tick
};

}  // namespace

SwapResult swap_controller(const std::filesystem::path& file, const std::string& other) {
  RecordedRun run{file};
  return Swap{run, runtime::chosen_controller(other, run.rig())}.make();
}

}  // namespace crane::replay
