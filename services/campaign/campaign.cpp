#include "campaign/campaign.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <type_traits>

#include "crane/workers/process_pool.hpp"
#include "experiments/tick_log.hpp"

namespace crane::campaign {
namespace {

static_assert(std::is_trivially_copyable_v<Result>);  // the result is sent from process to process as bytes

/// Hashes the parts of a tuple to a seed (splitmix64).
std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t x = a * 0x9E3779B97F4A7C15ULL + b * 0xBF58476D1CE4E5B9ULL + c + 1;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

Random random_of(const Tuple& tuple) {
  return Random{
      mixed(static_cast<std::uint64_t>(tuple.hazard), static_cast<std::uint64_t>(tuple.moment), tuple.seed)};
}
/// Independent of the moment: a hazard changes the rig in the same way for every moment.
Random random_of_preparation(const Tuple& tuple) {
  return Random{mixed(static_cast<std::uint64_t>(tuple.hazard), 99, tuple.seed)};
}

bool is_over(const Bench& bench) {
  const Row& row = bench.now();
  for (std::size_t i = 0; i < kAxes; ++i)
    if (bench.setting().configured.drives[i].present && !row.truth.brake_closed[i]) return false;
  return row.status.state >= crane_STATE_STOP_C0 || row.status.state == crane_STATE_LOCKED;
}

/// Runs until the crane has been at rest for kAfterwards_s, or the observation time of the injection is over.
void watch(Bench& bench, const Injection& injection, Run& run) {
  constexpr double kAfterwards_s = 0.25, kControlledStop_s = 8.5;
  const double period_s = bench.setting().configured.period_s;
  double over_s = 0;
  for (double t_s = 0; t_s < injection.watched_s + kControlledStop_s && over_s < kAfterwards_s;
       t_s += period_s) {
    if (t_s >= injection.watched_s && bench.now().status.state != crane_STATE_STOP_C1) break;
    bench.tick();
    if (!run.visible_ns && (!injection.visible || injection.visible())) run.visible_ns = bench.now().time_ns;
    const bool must_go_on =
        injection.expectation.brakes_do_not_close || injection.expectation.detection_ms > 1000;
    over_s = is_over(bench) && !(must_go_on && t_s < injection.watched_s) ? over_s + period_s : 0;
  }
}

Result result_of(const Tuple& tuple, const Expectation& expected, const Verdict& verdict) {
  Result result{.tuple = tuple};
  for (const auto& violation : verdict.violations)
    result.violations |= 1U << static_cast<unsigned>(violation.invariant);
  if (!verdict.violations.empty()) verdict.violations.front().what.copy(result.what, sizeof result.what - 1);
  result.stopped = verdict.first.has_value();
  result.first = verdict.first.value_or(Reason{});
  result.right = !(result.violations & (1U << static_cast<unsigned>(Invariant::right_reason)));
  result.detection_ms = verdict.detection_ms.value_or(-1);
  result.zero_volts_ms = verdict.zero_volts_ms.value_or(-1);
  result.braked_ms = verdict.braked_ms.value_or(-1);
  result.bound_ms = expected.detection_ms;
  result.beyond_limit = verdict.beyond_limit;
  return result;
}

void write_recording(const std::filesystem::path& recording, const std::vector<Row>& rows) {
  experiments::TickLog log{recording};
  for (const Row& row : rows)
    log.add({.state = &row.state,
             .reference = &row.reference,
             .tracking = &row.tracking,
             .anti_swing = &row.anti_swing,
             .demand = &row.demand,
             .command = &row.command,
             .supervisor = &row.status});
  log.close();
}

/// Injects the fault into a prepared crane and judges the run.
Result inject(const Tuple& tuple, Bench& bench, const std::optional<std::filesystem::path>& recording) {
  const Hazard& hazard = *find_hazard(tuple.hazard);
  Random random = random_of(tuple);
  constexpr std::size_t kSpread_ticks = 8;
  const auto later = random.pick(kSpread_ticks);
  if (tuple.moment != Moment::brake_release && !hazard.from_power_on)
    bench.run(static_cast<double>(later) * bench.setting().configured.period_s);
  const auto begin_ns = bench.next_tick_ns();
  Injection what = hazard.inject(bench, random);
  Run run{.begin_ns = begin_ns, .onset_ns = bench.next_tick_ns(), .expectation = what.expectation};
  if (const auto reply = bench.reply()) run.accepted = reply->accepted;
  watch(bench, what, run);
  run.rows = bench.take_rows();
  if (recording) write_recording(*recording, run.rows);
  return result_of(tuple, what.expectation, judge(bench.setting().configured, run));
}

/// Prepares the crane for this run only. A refused configuration is a result, not an error.
Result run_alone(const Tuple& tuple, const std::optional<std::filesystem::path>& recording) {
  const Hazard& hazard = *find_hazard(tuple.hazard);
  Setting made = setting(tuple.seed % kSettings, tuple.moment);
  Random random = random_of_preparation(tuple);
  if (hazard.prepare != nullptr) hazard.prepare(made, random);
  try {
    Bench bench{std::move(made)};
    if (!hazard.from_power_on && !bench.prepare(tuple.moment)) return {.tuple = tuple, .prepared = false};
    return inject(tuple, bench, recording);
  } catch (const configuration::ConfigurationError&) {
    return {.tuple = tuple, .right = true};
  }
}

bool shares_preparation(const Tuple& tuple) {
  const Hazard& hazard = *find_hazard(tuple.hazard);
  return hazard.prepare == nullptr && !hazard.from_power_on;
}

void send(const workers::Outbox& outbox, const Result& result) {
  outbox.send({reinterpret_cast<const char*>(&result), sizeof result});
}

/// Executes one run in a separate process.
void run_forked(const Tuple& tuple, const workers::Outbox& outbox, const std::function<Result()>& run) {
  workers::run({.count = 1,
                .work = [&](std::size_t, const workers::Outbox&) { send(outbox, run()); },
                .take = [](std::size_t, const std::string&) {},
                .ended =
                    [&](std::size_t, const std::string& failure) {
                      if (!failure.empty()) send(outbox, {.tuple = tuple, .crashed = true});
                    }});
}

struct Group {
  std::uint64_t setting;
  Moment moment;
  auto operator<=>(const Group&) const = default;
};

void run_group(const Group& place, const std::vector<Tuple>& tuples, const workers::Outbox& outbox) {
  std::optional<Bench> prepared;
  bool ready = false;
  for (const auto& tuple : tuples) {
    if (!shares_preparation(tuple)) {
      run_forked(tuple, outbox, [&] { return run_alone(tuple, {}); });
      continue;
    }
    if (!prepared) {
      prepared.emplace(setting(place.setting, place.moment));
      ready = prepared->prepare(place.moment);
    }
    if (!ready)
      send(outbox, {.tuple = tuple, .prepared = false});
    else
      run_forked(tuple, outbox, [&] { return inject(tuple, *prepared, {}); });
  }
}

}  // namespace

std::string to_string(const Tuple& tuple) {
  return "--hazard " + std::to_string(tuple.hazard) + " --moment " + std::string{name_of(tuple.moment)} +
         " --seed " + std::to_string(tuple.seed);
}

std::vector<Tuple> tuples(const Selection& selection) {
  std::vector<Tuple> all;
  const auto wanted = [](const auto& list, const auto& item) {
    return list.empty() || std::ranges::find(list, item) != list.end();
  };
  for (std::uint64_t i = 0; i < selection.seeds; ++i)
    for (std::size_t m = 0; m < kMoments; ++m)
      for (const Hazard& hazard : hazards()) {
        const auto moment = static_cast<Moment>(m);
        const auto seed = selection.first_seed + i;
        if (hazard.test_bed == TestBed::campaign && seed % hazard.every == 0 &&
            wanted(selection.moments, moment) && wanted(selection.hazards, hazard.number))
          all.push_back({hazard.number, moment, seed});
      }
  return all;
}

Result run_one(const Tuple& tuple, const std::optional<std::filesystem::path>& recording) {
  return run_alone(tuple, recording);
}

void run_all(const std::vector<Tuple>& tuples, unsigned jobs,
             const std::function<void(const Result&)>& done) {
  std::map<Group, std::vector<Tuple>> by_place;
  for (const auto& tuple : tuples) by_place[{tuple.seed % kSettings, tuple.moment}].push_back(tuple);
  const std::vector<std::pair<Group, std::vector<Tuple>>> groups{by_place.begin(), by_place.end()};
  workers::run(
      {.count = groups.size(),
       .at_a_time = jobs,
       .work = [&](std::size_t i,
                   const workers::Outbox& outbox) { run_group(groups[i].first, groups[i].second, outbox); },
       .take =
           [&](std::size_t, const std::string& record) {
             Result result;
             std::memcpy(&result, record.data(), std::min(sizeof result, record.size()));
             done(result);
           },
       .ended = workers::require_success});
}

}  // namespace crane::campaign
