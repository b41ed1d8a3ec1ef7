// Extreme values in every field of every topic. One process of the stack publishes a wrong value in one
// field, in one sample or in every sample. The limits of the crane and the stop of the operator must still
// act, and no process may hang or end. CRANE_SWEEP=all runs all values at three moments on two axes.
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>

#include "campaign/judge/judge.hpp"
#include "campaign/traffic.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/workers/process_pool.hpp"
#include "observation/field_table.hpp"

namespace crane::campaign {
namespace {

using Kind = bus::CdrCodec::Field::Kind;

/// One field, or one element of an array.
struct Place {
  const topics::Description* topic;
  std::string name;  ///< "crane/state.header.tick"
  bus::CdrCodec::Field field;
  std::uint32_t offset;  ///< bytes from the start of the C struct
};

/// Source, epoch and checksum are omitted: the bus writes them.
std::vector<Place> places() {
  std::vector<Place> all;
  const observation::FieldTable table;
  for (std::size_t t = 0; t < topics::kAll.size(); ++t) {
    const auto& topic = topics::kAll[t];
    const auto& leaves = table.topics().at(t).leaves;
    std::size_t leaf = 0;
    for (const auto& field : bus::CdrCodec::of(*topic.descriptor).fields()) {
      const bool text = field.kind == Kind::string;
      for (std::uint32_t i = 0; i < (text ? 1 : field.count); ++i, ++leaf) {
        const std::string& name = leaves.at(leaf).name;
        if (text || name == "header.source" || name == "header.epoch" || name == "crc32c") continue;
        all.push_back({&topic, std::string{topic.name} + "." + name, field, field.offset + i * field.size});
      }
    }
  }
  return all;
}

/// The first kQuick values are those of the short sweep.
constexpr std::array kFloats{
    std::numeric_limits<double>::quiet_NaN(), -1e15, HUGE_VAL, -HUGE_VAL, 1e308, -1e308, 1e4, 5e-324};
constexpr std::size_t kIntegers = 7, kQuick = 2;

std::size_t values_of(const Place& place, bool all) {
  if (place.field.kind == Kind::boolean) return 1;
  if (place.field.kind == Kind::enumeration)
    return all ? place.field.enum_max : std::min<std::size_t>(place.field.enum_max, kQuick);
  if (!all) return kQuick;
  return place.field.kind == Kind::floating ? kFloats.size() : kIntegers;
}

/// Writes wrong value number `k` into the field.
void falsify_place(void* sample, const Place& place, std::size_t k) {
  auto* const at = static_cast<std::uint8_t*>(sample) + place.offset;
  const std::size_t bytes = place.field.size;
  std::uint64_t bits = 0;
  std::memcpy(&bits, at, bytes);
  const std::uint64_t highest = std::uint64_t{1} << (8 * bytes - 1);
  if (place.field.kind == Kind::floating)
    std::memcpy(&bits, &kFloats.at(k), sizeof bits);
  else if (place.field.kind == Kind::boolean)
    bits ^= 1U;
  else if (place.field.kind == Kind::enumeration)
    bits = (bits + 1 + k) % (place.field.enum_max + 1);
  else
    bits = std::array<std::uint64_t, kIntegers>{highest - 1, highest,          0, ~std::uint64_t{0}, bits + 1,
                                                bits - 1,    bits + 50'000'000}
               .at(k);
  std::memcpy(at, &bits, bytes);
}

/// What happens after the wrong value.
enum class Then : std::uint8_t {
  runaway,  ///< the demand drives the axis outwards at 8 V
  stop,     ///< the operator requests a stop, but the demand moves the axis back and forth
  move      ///< in the tick of the fault, the operator requests a move; later the demand runs away
};

struct Case {
  std::size_t place, value;
  bool always;  ///< false: in one sample
  Then then;
};

std::string title(const Place& place, const Case& one) {
  static constexpr std::array kThen{"runaway", "stop", "move"};
  return place.name + ", value " + std::to_string(one.value) + (one.always ? ", always, " : ", once, ") +
         kThen[static_cast<std::size_t>(one.then)];
}

bool is_braked(const Bench& bench) {
  const Row& row = bench.now();
  for (std::size_t i = 0; i < kAxes; ++i)
    if (bench.setting().configured.drives[i].present && !row.truth.brake_closed[i]) return false;
  return true;
}

bool is_latched(const Bench& bench) { return bench.now().state.latch_reason != crane_LATCH_NONE; }

double wrong_demand_v(const Bench& bench, Then then) {
  constexpr std::int64_t kHalfPeriod_ns = 200'000'000;
  const std::size_t i = bench.axis();
  if (then == Then::stop) return bench.now().time_ns / kHalfPeriod_ns % 2 == 0 ? 3 : -3;
  return bench.setting().target[i] > bench.setting().configured.start.position[i] ? 8 : -8;
}

/// A status or command that the fault itself has made wrong is no evidence: only the true motion is.
bool is_evidence(const Violation& violation, const Place& place) {
  using enum Invariant;
  const bool by_truth = violation.invariant == inside_limits || violation.invariant == braked_stays;
  const bool by_reason = violation.invariant == right_reason || violation.invariant == no_false_trip;
  const bool wrong_evidence = place.topic->name == topics::command.description.name ||
                              place.topic->name == topics::supervisor.description.name ||
                              place.name == "crane/state.latch_reason";
  return by_truth || (!by_reason && !wrong_evidence);
}

/// @return every problem, one a line
std::string problems_of(Bench& bench, const Place& place, const Case& one) {
  constexpr double kControlledStop_s = 8.4, kTravelToTheLimit_s = 12;
  const auto begin_ns = bench.next_tick_ns();
  bool sent = false, runs_away = false;
  bench.publish_fault = [&](const topics::Description& topic, void* sample) {
    const bool changes = runs_away && topic.name == topics::demand.description.name;
    if (changes) static_cast<msg::Demand*>(sample)->total_v[bench.axis()] = wrong_demand_v(bench, one.then);
    if (topic.name != place.topic->name || (sent && !one.always)) return changes;
    sent = true;
    falsify_place(sample, place, one.value);
    return true;
  };
  if (one.then == Then::move) bench.request_move();
  bench.run(0.3);
  const bool continues = !is_braked(bench), was_latched = is_latched(bench);
  runs_away = true;
  if (continues && one.then == Then::stop) bench.send(crane_REQUEST_STOP);
  std::string found;
  const bool replaces_volts = one.always && (place.name.starts_with("crane/demand.total_v") ||
                                             place.name.starts_with("crane/command.drive_v"));
  if (!bench.run_until([&] { return is_braked(bench); },
                       one.then == Then::stop ? kControlledStop_s : kTravelToTheLimit_s) &&
      !replaces_volts)
    found += "  the crane has not stopped\n";
  if (continues && !one.always && bench.now().status.cause == crane_CAUSE_BRIDGE_LATCHED && !was_latched &&
      place.topic->name != topics::supervisor.description.name && place.name != "crane/state.latch_reason")
    found += "  the bridge has stopped the crane before the supervisor\n";
  bench.run(0.2);
  Run run{.begin_ns = begin_ns, .onset_ns = begin_ns};
  run.rows = bench.take_rows();
  std::set<Invariant> reported;
  for (const auto& violation : judge(bench.setting().configured, run).violations)
    if (is_evidence(violation, place) && reported.insert(violation.invariant).second)
      found += std::string{"  "} + name_of(violation.invariant) + ": " + violation.what + "\n";
  return found;
}

/// Runs all cases from one prepared crane, each in a separate process. A process that hangs is ended.
void sweep(Bench& bench, const std::vector<Place>& all, const std::vector<Case>& cases) {
  constexpr unsigned kLongest_s = 20;
  workers::run({.count = cases.size(),
                .at_a_time = 2,
                .work =
                    [&](std::size_t i, const workers::Outbox& outbox) {
                      ::alarm(kLongest_s);
                      outbox.send(problems_of(bench, all[cases[i].place], cases[i]));
                    },
                .take =
                    [&](std::size_t i, const std::string& found) {
                      EXPECT_EQ(found, "") << title(all[cases[i].place], cases[i]);
                    },
                .ended =
                    [&](std::size_t i, const std::string& failure) {
                      EXPECT_EQ(failure, "") << title(all[cases[i].place], cases[i]);
                    }});
}

class ValueSweep : public testing::Test {
 protected:
  void SetUp() override { spdlog::set_level(spdlog::level::off); }
  void TearDown() override { spdlog::set_level(spdlog::level::info); }

  void run(Moment moment, std::uint64_t number, const std::vector<Then>& thens) {
    SCOPED_TRACE("moment " + std::string{name_of(moment)} + ", setting " + std::to_string(number));
    std::vector<Case> cases;
    for (std::size_t p = 0; p < all_.size(); ++p)
      for (std::size_t v = 0; v < values_of(all_[p], everything_); ++v)
        for (const bool always : {false, true})
          for (const Then then : thens) cases.push_back({p, v, always, then});
    ASSERT_GT(cases.size(), 100U);
    Bench bench{setting(number, moment)};
    ASSERT_TRUE(bench.prepare(moment));
    sweep(bench, all_, cases);
  }

  const char* wanted_ = std::getenv("CRANE_SWEEP");  // NOLINT(concurrency-mt-unsafe): one thread
  bool everything_ = wanted_ != nullptr && std::string_view{wanted_} == "all";
  std::vector<Place> all_ = places();
};

TEST_F(ValueSweep, InMotionLeavesTheLimitsInForce) { run(Moment::cruise, 0, {Then::runaway}); }

TEST_F(ValueSweep, AtARequestToMoveLeavesTheLimitsInForce) { run(Moment::armed_idle, 0, {Then::move}); }

TEST_F(ValueSweep, LeavesTheStopOfTheOperatorInForce) {
  const auto is_of_state = [](const Place& place) {
    return place.topic->name == topics::state.description.name;
  };
  if (!everything_) std::erase_if(all_, [&](const Place& place) { return !is_of_state(place); });
  run(Moment::cruise, 0, {Then::stop});
}

TEST_F(ValueSweep, AtOtherMomentsOfOtherAxesLeavesTheLimitsInForce) {
  if (!everything_) GTEST_SKIP() << "set CRANE_SWEEP=all";
  for (const auto moment : {Moment::armed_idle, Moment::brake_release, Moment::stop})
    for (const std::uint64_t number : {2, 5}) run(moment, number, {Then::runaway});
}

}  // namespace
}  // namespace crane::campaign
