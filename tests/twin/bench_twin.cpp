/// Measures the live twin with simulated motion: false alarms in hours without faults; for each cause and
/// size the time to the alarm and the named cause. `bench_twin --help`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>

#include "simulated_motion.hpp"

namespace crane::test {
namespace {

struct Options {
  std::string rig = CRANE_RIGS "/virginia_tech_tower.toml";
  double hours = 10;
  int runs = 20;
  std::uint64_t seed = 1;
  Disturbance disturbance;
  std::string cause;  ///< empty: every cause
  bool only_alarms = false, only_causes = false, verbose = false;
};

struct Fault {
  std::string cause, axis, size;
  std::function<void(SimulatedMotion&, double sign)> happen;
  bool unseen = false;  ///< true: the twin misses the ticks of the change
};

void false_alarms(const Options& options, const configuration::Rig& rig) {
  constexpr double kRun_s = 1800;
  const auto ticks = static_cast<long>(kRun_s / rig.period_s);
  const int runs = std::max(1, static_cast<int>(std::lround(options.hours * 3600 / kRun_s)));
  int alarms = 0;
  double most = 0, twin_s = 0;
  std::uint64_t judged = 0;
  for (int run = 0; run < runs; ++run) {
    SimulatedMotion motion{rig, options.seed + static_cast<std::uint64_t>(run), options.disturbance};
    twin::Twin twin{rig};
    bool deviated = false;
    for (long k = 0; k < ticks; ++k) {
      const twin::Sample sample = motion.next();
      const auto begin = std::chrono::steady_clock::now();
      const twin::Judgement& j = twin.step(sample);
      twin_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const bool deviates = j.state == twin::State::deviates;
      if (!deviates && j.state == twin::State::watching) most = std::max(most, j.evidence);
      if (deviates && !deviated) ++alarms;
      deviated = deviates;
      if (const auto notice = twin.take_notice(); notice && options.verbose)
        std::cout << "seed " << options.seed + static_cast<std::uint64_t>(run) << ", "
                  << static_cast<double>(k) * rig.period_s << " s: " << notice->what << '\n';
    }
    judged += twin.judgement().judged_ticks;
  }
  const double hours = static_cast<double>(judged) * rig.period_s / 3600;
  std::cout << "in control: " << alarms << " false alarms in " << std::setprecision(4) << hours
            << " h judged; largest evidence without one " << most << "; "
            << twin_s / static_cast<double>(runs) / static_cast<double>(ticks) * 1e6 << " us per tick\n";
}

std::vector<Fault> faults_of(const configuration::Rig& rig) {
  std::vector<Fault> faults;
  const auto term = [&](const std::string& cause, const std::string& axis, const std::string& size,
                        const std::string& parameter, double null, double by) {
    faults.push_back({cause, axis, size, [=](SimulatedMotion& motion, double sign) {
                        motion.become_with({cause, axis, {{parameter, null + sign * by}}});
                      }});
  };
  for (const double v : {0.1, 0.2, 0.4}) {
    const std::string size = std::to_string(v).substr(0, 3) + " V";
    term("coulomb_friction", "trolley", size, "level_v", 0, v);
    term("coulomb_friction", "slew", size, "level_v", 0, v);
  }
  term("viscous_friction", "trolley", "0.5 V s/m", "vspm", 0, 0.5);
  term("viscous_friction", "trolley", "1 V s/m", "vspm", 0, 1);
  term("viscous_friction", "slew", "0.1 V s/rad", "vspm", 0, 0.1);
  term("viscous_friction", "slew", "0.2 V s/rad", "vspm", 0, 0.2);
  for (const double g : {0.05, 0.1}) {
    const std::string size = std::to_string(static_cast<int>(100 * g + 0.5)) + " %";
    term("motor_gain", "trolley", size, "factor", 1, g);
    term("motor_gain", "slew", size, "factor", 1, g);
  }
  for (const double share : {0.1, 0.25, 0.5})
    term("payload_mass", "", std::to_string(static_cast<int>(100 * share + 0.5)) + " %", "delta_kg", 0,
         share * rig.plant.load_mass_kg);
  for (const double m : {0.03, 0.1})
    term("cable_length", "", std::to_string(static_cast<int>(100 * m + 0.5)) + " cm", "delta_m", 0, m);
  for (const double mrad : {10, 20}) {
    const std::string size = std::to_string(static_cast<int>(mrad)) + " mrad";
    term("swing_offset", "radial", size, "offset_rad", 0, mrad / 1000);
    faults.back().unseen = true;
    term("swing_offset", "tangential", size, "offset_rad", 0, mrad / 1000);
    faults.back().unseen = true;
  }
  term("position_drift", "trolley", "2 %", "rate", 0, 0.02);
  term("position_drift", "slew", "2 %", "rate", 0, 0.02);
  const auto slip = [&](std::size_t column, const std::string& size, double by) {
    faults.push_back({twin::kEncoderSlip, twin::coordinate_of(column).axis, size,
                      [=](SimulatedMotion& motion, double sign) { motion.slip(column, sign * by); }});
  };
  slip(0, "1 mm", 1e-3), slip(0, "5 mm", 5e-3), slip(1, "2 mrad", 2e-3), slip(2, "5 mrad", 5e-3);
  for (const double push : {0.1, 0.3})
    faults.push_back({twin::kLoadPushed, "radial", std::to_string(push).substr(0, 3) + " rad/s",
                      [=](SimulatedMotion& motion, double sign) { motion.push(sign * push, 0); }});
  return faults;
}

struct Outcome {
  double alarm_s = -1, notice_s = -1;
  bool named = false, rival = false;
  std::string said;
};

Outcome one_run(const Options& options, const configuration::Rig& rig, const Fault& fault,
                std::uint64_t seed) {
  constexpr double kInControl_s = 45, kPatience_s = 60;
  SimulatedMotion motion{rig, seed, options.disturbance};
  twin::Twin twin{rig};
  Outcome outcome;
  const long before = std::lround((kInControl_s + static_cast<double>(seed % 7)) / rig.period_s);
  for (long k = 0; k < before; ++k) twin.step(motion.next());
  if (twin.judgement().state == twin::State::deviates) outcome.said = "(before) ";
  fault.happen(motion, seed % 2 == 0 ? 1 : -1);
  if (fault.unseen) motion.next();
  const std::string label = fault.axis.empty() ? fault.cause : fault.cause + " (" + fault.axis + ")";
  for (long k = 0; k < std::lround(kPatience_s / rig.period_s); ++k) {
    const twin::Judgement& j = twin.step(motion.next());
    const double time_s = static_cast<double>(k + 1) * rig.period_s;
    if (outcome.alarm_s < 0 && j.state == twin::State::deviates) outcome.alarm_s = time_s;
    if (const auto notice = twin.take_notice(); notice && notice->deviates) {
      outcome.notice_s = time_s;
      outcome.said += notice->what;
      outcome.named = j.cause == fault.cause && j.axis == fault.axis;
      outcome.rival = notice->what.find("or " + label) != std::string::npos;
      break;
    }
  }
  return outcome;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

void delays(const Options& options, const configuration::Rig& rig) {
  std::cout << "| cause | size | found | alarm median [s] | 90 % [s] | event median [s] | named | named as "
               "second |\n"
               "|---|---|---|---|---|---|---|---|\n";
  for (const Fault& fault : faults_of(rig)) {
    if (!options.cause.empty() && fault.cause != options.cause) continue;
    std::vector<double> alarm, notice;
    int named = 0, rival = 0;
    for (int run = 0; run < options.runs; ++run) {
      const Outcome outcome = one_run(options, rig, fault, options.seed + static_cast<std::uint64_t>(run));
      if (outcome.alarm_s >= 0) alarm.push_back(outcome.alarm_s);
      if (outcome.notice_s >= 0) notice.push_back(outcome.notice_s);
      named += outcome.named, rival += outcome.rival;
      if (options.verbose && !outcome.named) std::cout << "  seed " << run << ": " << outcome.said << '\n';
    }
    std::cout << "| " << fault.cause << (fault.axis.empty() ? "" : " (" + fault.axis + ")") << " | "
              << fault.size << " | " << alarm.size() << " of " << options.runs << " | " << std::fixed
              << std::setprecision(1) << percentile(alarm, 0.5) << " | " << percentile(alarm, 0.9) << " | "
              << percentile(notice, 0.5) << " | " << named << " | " << rival << " |" << std::defaultfloat
              << std::endl;
  }
}

int run(int argc, char** argv) {
  CLI::App app{"False alarms and detection delays of the live twin on simulated motion (docs/twin.md).",
               "bench_twin"};
  Options options;
  app.add_option("--rig", options.rig, "rig file of a tower")->capture_default_str();
  app.add_option("--hours", options.hours, "motion without a fault")->capture_default_str();
  app.add_option("--runs", options.runs, "runs per cause and size")->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the first run")->capture_default_str();
  app.add_option("--drive-noise", options.disturbance.drive_v, "coloured disturbance of the drives [V]");
  app.add_option("--swing-noise", options.disturbance.swing_radps2, "of the swing [rad/s2]");
  app.add_option("--cause", options.cause, "only this one");
  app.add_flag("--only-false-alarms", options.only_alarms, "no faults");
  app.add_flag("--only-delays", options.only_causes, "faults only");
  app.add_flag("--verbose", options.verbose, "what was said instead");
  CLI11_PARSE(app, argc, argv);
  const auto rig = configuration::load_rig(options.rig);
  std::cout << "seed " << options.seed << ", disturbance " << options.disturbance.drive_v << " V, "
            << options.disturbance.swing_radps2 << " rad/s2\n";
  if (!options.only_causes) false_alarms(options, rig);
  if (!options.only_alarms) delays(options, rig);
  return 0;
}

}  // namespace
}  // namespace crane::test

int main(int argc, char** argv) { return crane::test::run(argc, argv); }
