/// The list of all hazards, and functions that several hazards share.
#include "campaign/hazards.hpp"

#include "campaign/judge/truth.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {

double direction(const Bench& bench) {
  return bench.setting().target[bench.axis()] >= bench.setting().configured.start.position[bench.axis()] ? 1
                                                                                                         : -1;
}

std::int32_t counts(const Bench& bench, std::size_t counter, double change) {
  const auto& encoder = bench.setting().configured.encoders[counter];
  return static_cast<std::int32_t>(std::llround(change * encoder.counts_per_unit * encoder.sign));
}

std::size_t swing_counter(const Bench& bench) { return bench.axis() == 1 ? 4 : 3; }

void freeze(Bench& bench, std::size_t counter) {
  auto at = std::make_shared<std::optional<std::int32_t>>();
  bench.rig().change_inputs = [at, counter](bridge::Inputs& inputs) {
    if (!*at) *at = inputs.raw_counts[counter];
    inputs.raw_counts[counter] = **at;
  };
}

std::function<bool()> sees_error(Bench& bench, std::size_t counter, double error) {
  return [&bench, counter, error] { return bench.rig().shown_error()[counter] > error; };
}

std::function<bool()> crosses_limit(Bench& bench, Reason reason) {
  return [&bench, reason] {
    return is_true(reason, bench.setting().configured, bench.rows(), bench.rows().size() - 1);
  };
}

/// Pushes the load so that it swings with the amplitude `rad`.
void push(Bench& bench, double rad) {
  const double cable_m = bench.now().truth.position[2];
  const double rate_radps = std::sqrt(2 * 9.81 / cable_m * (1 - std::cos(rad)));
  const bool radial = swing_counter(bench) == 3;
  bench.rig().board().kick(radial ? rate_radps : 0, radial ? 0 : rate_radps);
}

/// A limit switch is pressed at a wrong position of the axis.
Injection switch_at_wrong_position(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const bool high = random.pick(2) == 0;
  bench.rig().change_inputs = [i, high](bridge::Inputs& inputs) {
    (high ? inputs.limit_high : inputs.limit_low)[i] = true;
  };
  const auto& drive = bench.setting().configured.drives[i];
  const double x = bench.now().truth.position[i];
  const bool near =
      high ? x > drive.high_limit - 1.2 * drive.soft_margin : x < drive.low_limit + 1.2 * drive.soft_margin;
  std::vector<Reason> reasons{latched(crane_LATCH_LOST_COUNTS)};
  if (near) reasons.push_back(because(crane_CAUSE_LIMIT_SWITCH));
  return {.expectation = {.reasons = reasons, .detection_ms = 10}};
}

Injection refusal() { return {.expectation = {.refused = true}, .watched_s = 0.3}; }

void emergency_stop(Bench& bench) {
  bench.request(crane_REQUEST_ESTOP);
  bench.run(0.3);
}

std::vector<Reason> drive_reasons() {
  return {because(crane_CAUSE_FOLLOWING_ERROR), latched(crane_LATCH_DRIVE_RESPONSE),
          latched(crane_LATCH_ENCODER_FROZEN)};
}

Injection lost_demand(double watched_s) {
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_STALE)},
                          .detection_ms = 50,
                          .communication = true},
          .watched_s = watched_s};
}
Injection lost_command() {
  return {.expectation = {
              .reasons = {latched(crane_LATCH_COMMAND_STALE)}, .detection_ms = 60, .communication = true}};
}
Injection lost_state() {
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), latched(crane_LATCH_COMMAND_STALE)},
                          .detection_ms = 60,
                          .communication = true}};
}
Injection nothing() { return {.expectation = {}, .watched_s = 0.6}; }

namespace {
std::vector<Hazard> every_hazard() {
  std::vector<Hazard> all;
  for (const auto part :
       {process_hazards(), sample_hazards(), encoder_hazards(), drive_hazards(), load_hazards(),
        brake_hazards(), faulty_supervisor_hazards(), request_hazards(), start_hazards()})
    all.insert(all.end(), part.begin(), part.end());
  std::ranges::sort(all, {}, &Hazard::number);
  return all;
}
}  // namespace

std::span<const Hazard> hazards() {
  static const std::vector<Hazard> kAll = every_hazard();
  return kAll;
}

const Hazard* find_hazard(int number) {
  const auto all = hazards();
  const auto found = std::ranges::find(all, number, &Hazard::number);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace crane::campaign
