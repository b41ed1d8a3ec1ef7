#include "truth/truth.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "controller.hpp"
#include "effects.hpp"

namespace truth {
namespace {

/// Disturbance of a rig of this kind and seed, equal in every run of the case.
Disturbance disturbance_of(const Case& request) {
  Random random{request.seed, "disturbance"};
  Disturbance d;
  d.drive_v = random.uniform(0.02, 0.05) * request.disturbance;
  d.load_n = random.uniform(0.005, 0.015) * request.disturbance;
  d.correlation_s = random.uniform(0.3, 1.0);
  d.noise_counts = request.sensor_noise ? random.uniform(0.2, 0.6) : 0;
  d.quantised = request.sensor_noise;
  return d;
}

struct Bench {
  Physics nominal, real;
  Disturbance disturbance;
};

Bench bench_of(const Case& request, std::vector<Found>& answer) {
  Bench bench;
  bench.nominal = rig(request.rig);
  bench.real = bench.nominal;
  for (const Hidden& hidden : request.effects) answer.push_back(apply(hidden, bench.real, request.seed));
  bench.disturbance = disturbance_of(request);
  return bench;
}

std::vector<std::string> columns_of(const Physics& p) {
  std::vector<std::string> columns{"time_s"};
  if (p.drive[0].present) columns.push_back("trolley_voltage_v");
  if (p.drive[1].present) columns.push_back("slew_voltage_v");
  if (p.drive[0].present) columns.push_back("trolley_position_m");
  if (p.drive[1].present) columns.push_back("slew_angle_rad");
  if (p.radial) columns.push_back("swing_radial_rad");
  if (p.tangential) columns.push_back("swing_tangential_rad");
  if (p.load_kg > 0) columns.push_back("cable_length_m");
  return columns;
}

std::vector<double> row_of(const Physics& p, double time_s, const Volts& v, const Sensed& s) {
  std::vector<double> row{time_s};
  if (p.drive[0].present) row.push_back(v[0]);
  if (p.drive[1].present) row.push_back(v[1]);
  if (p.drive[0].present) row.push_back(s[0]);
  if (p.drive[1].present) row.push_back(s[1]);
  if (p.radial) row.push_back(s[2]);
  if (p.tangential) row.push_back(s[3]);
  if (p.load_kg > 0) row.push_back(p.cable_m);
  return row;
}

/// Such data do not exist: a crane that swings up to the jib or leaves its track would have been stopped.
void require_inside(const Physics& p, const Sensed& measured, const std::string& kind) {
  constexpr double kMostSwing_rad = 1, kMargin = 0.35;
  const double margin = kMargin * (p.high[0] - p.low[0]);
  const bool inside = measured[0] >= p.low[0] - margin && measured[0] <= p.high[0] + margin;
  const bool hanging = std::abs(measured[2]) < kMostSwing_rad && std::abs(measured[3]) < kMostSwing_rad;
  if (!inside || !hanging)  // also true for NaN
    throw std::runtime_error("run = " + kind +
                             ": the crane leaves its range; the effects are too large for it");
}

/// Simulates one run in closed loop. Calls `visit(crane, command)` before every tick.
template <class Visit>
Run closed_loop(Bench bench, const Case& request, const std::string& kind, const std::string& file,
                Visit visit) {
  const std::string stream = file + " " + kind;
  const Plan plan = truth::plan(bench.nominal, kind, request.seconds, Random{request.seed, stream + " plan"});
  bench.real.cable_m = bench.nominal.cable_m = plan.cable_m;
  Crane crane{bench.real, bench.disturbance, plan.start, request.seed, stream};
  Controller controller{bench.nominal, plan};
  Run run{kind, file, columns_of(bench.nominal), {}};
  Volts applied{};
  const auto ticks = static_cast<std::size_t>(std::lround(plan.seconds / kTick_s));
  for (std::size_t k = 0; k <= ticks; ++k) {
    const double time_s = static_cast<double>(k) / 100;
    const Sensed measured = crane.measure();
    require_inside(bench.nominal, measured, kind);
    run.rows.push_back(row_of(bench.nominal, time_s, applied, measured));
    visit(crane, applied);
    crane.advance(applied);
    applied = crane.converted(controller.step(measured, time_s));
  }
  return run;
}

std::vector<Run> runs_of(const Bench& bench, const Case& request, const std::vector<std::string>& kinds,
                         const std::string& name) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    runs.push_back(closed_loop(bench, request, kinds[i], name + "_" + std::to_string(i + 1),
                               [](const Crane&, const Volts&) {}));
  return runs;
}

}  // namespace

Data generate(const Case& request) {
  Data data{request, {}, {}, {}};
  const Bench bench = bench_of(request, data.answer);
  data.training = runs_of(bench, request, request.training_runs, "train");
  data.test = runs_of(bench, request, request.test_runs, "test");
  return data;
}

Size effect_size(const Case& request) {
  constexpr int kWindow_ticks = 200;
  std::vector<Found> answer;
  const Bench bench = bench_of(request, answer);
  Sensed effect{}, disturbance{};
  double samples = 0;
  for (std::size_t i = 0; i < request.training_runs.size(); ++i) {
    std::vector<Crane> others;  // cranes without the effects and without the disturbance
    int tick = 0;
    const auto visit = [&](const Crane& crane, const Volts& applied) {
      if (tick++ % kWindow_ticks == 0) others = {crane.without_effects(bench.nominal), crane.undisturbed()};
      const Sensed real = crane.sense(), plain = others[0].sense(), quiet = others[1].sense();
      for (std::size_t k = 0; k < real.size(); ++k) {
        effect[k] += (real[k] - plain[k]) * (real[k] - plain[k]);
        disturbance[k] += (real[k] - quiet[k]) * (real[k] - quiet[k]);
      }
      samples += 1;
      for (Crane& other : others) other.advance(applied);
    };
    closed_loop(bench, request, request.training_runs[i], "train_" + std::to_string(i + 1), visit);
  }
  Size size;
  for (std::size_t k = 0; k < effect.size(); ++k) {
    size.effect[k] = std::sqrt(effect[k] / samples);
    size.disturbance[k] = std::sqrt(disturbance[k] / samples);
    if (size.disturbance[k] > 0) size.ratio = std::max(size.ratio, size.effect[k] / size.disturbance[k]);
  }
  return size;
}

const std::vector<std::string>& run_kinds() {
  static const std::vector<std::string> kinds{"rich",           "moves",    "slow",  "swing", "two_lengths",
                                              "rest_breakaway", "slew_180", "small", "large"};
  return kinds;
}

}  // namespace truth
