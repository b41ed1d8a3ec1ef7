#include "set.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

namespace mujoco_truth {
namespace {

/// Of twenty sets, five are clean, nine have one fault, two have two faults, two have one fault in data that
/// hardly distinguish it from others, and two have one fault outside the library.
constexpr std::array kPattern{SetKind::clean, SetKind::single, SetKind::single,  SetKind::outside,
                              SetKind::clean, SetKind::single, SetKind::pair,    SetKind::single,
                              SetKind::clean, SetKind::single, SetKind::single,  SetKind::confounded,
                              SetKind::clean, SetKind::single, SetKind::outside, SetKind::single,
                              SetKind::pair,  SetKind::clean,  SetKind::single,  SetKind::confounded};
constexpr std::array kWanted{1.0, 2.0, 4.0, 8.0};
constexpr double kOfPair = 4, kOfOutside = 6, kOfConfounded = 3;
/// A fault whose possible size is too far from the desired size is drawn again. After this number of draws,
/// the last fault is used.
constexpr double kNear = 0.7, kLeastSize = 0.7;
constexpr int kAttempts = 40, kPatient = 12;
constexpr double kAlike = 0.95;

const std::vector<std::string>& confusable() {
  static const std::vector<std::string> names{"command_delay",
                                              "steady_wind",
                                              "actuator_lag",
                                              "swing_delay",
                                              "command_offset",
                                              "swing_moving_average",
                                              "jib_tilt",
                                              "stribeck_friction",
                                              "swing_offset",
                                              "direction_asymmetry",
                                              "position_dependent_friction"};
  return names;
}

std::vector<FaultKind> of_library(bool in_library) {
  std::vector<FaultKind> some;
  std::copy_if(fault_kinds().begin(), fault_kinds().end(), std::back_inserter(some),
               [&](const FaultKind& kind) { return kind.in_library == in_library; });
  return some;
}

/// Kind of the set with this number, and number of earlier sets of this kind.
std::pair<SetKind, std::size_t> place_of(std::size_t number) {
  const SetKind kind = kind_of_set(number);
  std::size_t before = 0;
  for (std::size_t i = 0; i < number; ++i) before += kPattern[i % kPattern.size()] == kind ? 1 : 0;
  return {kind, before};
}

std::vector<FaultKind> wanted_faults(SetKind kind, std::size_t count, const Deck& deck, Chance& chance) {
  Chance order(deck.seed, std::string{"order "} + name_of(kind));
  std::vector<FaultKind> all = of_library(kind != SetKind::outside);
  if (kind == SetKind::confounded)
    std::erase_if(all, [](const FaultKind& k) {
      return std::find(confusable().begin(), confusable().end(), k.name) == confusable().end();
    });
  for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[order.below(i)]);
  if (kind == SetKind::clean) return {};
  const FaultKind first = all[count % all.size()];
  if (kind != SetKind::pair) return {first};
  for (;;) {
    const FaultKind& second = all[chance.below(all.size())];
    if (std::string{second.name} != first.name && !confounded(first.name, second.name))
      return {first, second};
  }
}

Kind drawn_kind(Chance& chance) {
  const double x = chance.uniform(0, 1);
  return x < 0.4 ? Kind::tower : x < 0.7 ? Kind::gantry : x < 0.85 ? Kind::drive_axis : Kind::pendulum;
}

double percentile_95(const std::vector<Run>& runs, const Rig& rig) {
  std::vector<double> all;
  for (const Run& run : runs)
    for (const Pose& pose : run.poses)
      for (std::size_t i = 0; i < kSwings; ++i)
        if (rig.has_swing(i)) all.push_back(std::abs(pose.swing[i]));
  if (all.empty()) return 0;
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

struct Plans {
  std::vector<RunPlan> train, test;
};

Plans drawn_plans(SetKind kind, const Rig& rig, const Nuisance& nuisance, Chance& chance) {
  const bool poor = kind == SetKind::confounded;
  const std::size_t train = poor ? 1 : 2 + chance.below(2), test = poor ? 1 : 1 + chance.below(2);
  const bool lengths = rig.hoist && chance.happens(0.5);
  Plans plans;
  for (std::size_t i = 0; i < train + test; ++i) {
    RunPlan plan;
    const bool rich = i == 0;
    plan.experiment =
        poor   ? Experiment::moves
        : rich ? chance.one_of<Experiment>({Experiment::moves, Experiment::sines})
               : chance.one_of<Experiment>({Experiment::moves, Experiment::sines, Experiment::steps,
                                            Experiment::sweep, Experiment::moves});
    // In at most one of the training runs, the drives are at rest and the load swings freely.
    if (rig.kind == Kind::pendulum || (i == 1 && rig.has_load() && i < train && chance.happens(0.3)))
      plan.experiment = Experiment::free_swing;
    plan.duration_s = poor                   ? chance.uniform(20, 25)
                      : chance.happens(0.15) ? chance.uniform(40, 60)
                                             : chance.uniform(20, 35);
    plan.cable_m = rig.cable_m * (lengths && i > 0 ? chance.one_of<double>({0.8, 1, 1.25}) : 1);
    plan.swing_rad =
        plan.experiment == Experiment::free_swing ? nuisance.swing_rad * chance.uniform(0.7, 1.3) : 0;
    plan.seed = static_cast<std::uint64_t>(chance.uniform(0, 1e15));
    (i < train ? plans.train : plans.test).push_back(plan);
  }
  return plans;
}

void scale(Plans& plans, double by) {
  for (auto* some : {&plans.train, &plans.test})
    for (RunPlan& plan : *some) plan.amplitude *= by;
}

std::vector<Run> all_recorded(const Physics& physics, const Nuisance& nuisance,
                              const std::vector<RunPlan>& plans) {
  std::vector<Run> runs;
  for (const RunPlan& plan : plans) {
    auto run = recorded(physics, nuisance, plan);
    if (!run) return {};
    runs.push_back(std::move(*run));
  }
  return runs;
}

/// Scales the motion until the load has the desired swing. @return the clean training runs with this motion
std::vector<Run> clean_runs(const Physics& physics, const Nuisance& nuisance, Plans& plans, Chance& chance) {
  constexpr double kLeast = 0.12, kMost = 2.5;
  const bool driven = physics.rig.kind == Kind::tower || physics.rig.kind == Kind::gantry;
  if (!driven) scale(plans, chance.log_uniform(0.15, 1));
  for (int i = 0; driven && i < 3; ++i) {
    RunPlan trial = plans.train[0];
    trial.duration_s = std::min(15.0, trial.duration_s);
    const auto run = recorded(physics, nuisance, trial);
    if (!run) {
      scale(plans, 0.6);
      continue;
    }
    const double wanted = nuisance.swing_rad / std::max(1e-4, percentile_95({*run}, physics.rig));
    const double now = plans.train[0].amplitude;
    if (wanted > 0.75 && wanted < 1.33) break;
    scale(plans, std::clamp(now * wanted, kLeast, kMost) / now);
  }
  for (int i = 0; i < 3; ++i) {
    auto runs = all_recorded(physics, nuisance, plans.train);
    if (!runs.empty()) return runs;
    scale(plans, 0.75);
  }
  return {};
}

Scored scaled(Fault fault, double wanted, const Visibility& visibility, const Rig& rig) {
  const double most = most_of(fault, rig);
  for (int i = 0; i < 4; ++i) {
    const double size = visibility.size({fault});
    if (size > 0.85 * wanted && size < 1.18 * wanted) break;
    const double factor = std::clamp(wanted / std::max(1e-6, size), 1e-3, 20.0);
    fault.amount = std::copysign(std::min(most, std::abs(fault.amount) * factor), fault.amount);
  }
  const auto columns = visibility.columns({fault});
  double size = 0;
  for (const Column& c : columns) size = std::max(size, c.effect / std::max(1e-12, c.nuisance));
  return {fault, wanted, size, columns};
}

std::vector<std::string> alike(const Fault& fault, const Visibility& visibility, const Rig& rig,
                               Chance& chance) {
  std::vector<std::string> names;
  for (const FaultKind& kind : of_library(true))
    for (const std::string& axis : axes_of(kind, rig)) {
      if (kind.name == fault.name && axis == fault.axis) continue;
      if (std::abs(visibility.cosine({fault}, {drawn_fault(kind, axis, rig, chance)})) > kAlike)
        names.push_back(axis.empty() ? kind.name : std::string{kind.name} + "@" + axis);
    }
  return names;
}

/// One attempt; a set without test runs has failed.
Set attempt(const Deck& deck, std::size_t number, int round, bool want_alike) {
  const auto [kind, count] = place_of(number);
  Chance chance(deck.seed, deck.name + " " + std::to_string(number) + " " + std::to_string(round));
  Set set;
  set.number = number;
  set.kind = kind;
  set.nuisance = drawn_nuisance(chance);
  // The kinds of the faults depend only on the number of the set, so that they are equal in every attempt.
  Chance which(deck.seed, deck.name + " faults " + std::to_string(number));
  const auto kinds = wanted_faults(kind, count, deck, which);
  set.rig = drawn_rig(drawn_kind(chance), set.nuisance, chance, set.nuisance.geometry);
  std::vector<Fault> faults;
  for (const FaultKind& k : kinds) {
    const auto axes = axes_of(k, set.rig);
    if (axes.empty()) return set;
    faults.push_back(drawn_fault(k, chance.one_of(axes), set.rig, chance));
  }
  Plans plans = drawn_plans(kind, set.rig, set.nuisance, chance);
  const Physics physics{set.rig, set.nuisance.law, set.nuisance.presliding_m, {}, {}, {}};
  const auto clean = clean_runs(physics, set.nuisance, plans, chance);
  if (clean.empty()) return set;
  set.swing_reached_rad = percentile_95(clean, set.rig);
  const bool driven = set.rig.kind == Kind::tower || set.rig.kind == Kind::gantry;
  // A swing of less than three counts gives no information.
  if (driven && set.swing_reached_rad * set.rig.swing_counts_per_rad < 3) return set;
  if (!faults.empty()) {
    const Visibility visibility(physics, clean);
    double wanted = kind == SetKind::pair ? kOfPair : kind == SetKind::outside ? kOfOutside : kOfConfounded;
    if (kind == SetKind::single) wanted = kWanted[(count + count / of_library(true).size()) % kWanted.size()];
    for (const Fault& fault : faults) {
      set.faults.push_back(scaled(fault, wanted, visibility, set.rig));
      const double least = round < kPatient ? kNear * wanted : kLeastSize;
      if (set.faults.back().size < least || set.faults.back().size > 2 * wanted) return set;
    }
    if (want_alike) set.alike = alike(set.faults[0].fault, visibility, set.rig, chance);
  }
  faults.clear();
  for (const Scored& scored : set.faults) faults.push_back(scored.fault);
  for (int i = 0; i < 3 && set.test.empty(); ++i) {
    set.train = faults.empty() ? clean : all_recorded(with(physics, faults), set.nuisance, plans.train);
    if (!set.train.empty()) set.test = all_recorded(with(physics, faults), set.nuisance, plans.test);
    if (set.test.empty()) scale(plans, 0.85);
  }
  return set;
}

}  // namespace

const char* name_of(SetKind kind) {
  return std::array{"clean", "single", "pair", "confounded", "outside"}[static_cast<std::size_t>(kind)];
}

SetKind kind_of_set(std::size_t number) { return kPattern[number % kPattern.size()]; }

Set made(const Deck& deck, std::size_t number, bool want_alike) {
  for (int round = 0; round < kAttempts; ++round) {
    Set set = attempt(deck, number, round, want_alike);
    if (!set.test.empty()) return set;
  }
  throw std::runtime_error("set " + std::to_string(number) + ": no crane shows its fault");
}

}  // namespace mujoco_truth
