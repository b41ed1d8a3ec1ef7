#include "score/deck.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "score/judgement.hpp"

namespace crane::diagnosis::score {
namespace {

constexpr std::array kPattern{Kind::single, Kind::clean, Kind::single, Kind::pair,
                              Kind::single, Kind::clean, Kind::single, Kind::outside,
                              Kind::single, Kind::clean, Kind::single, Kind::confounded};
constexpr std::array kMultiples{4.0, 2.0, 1.0};
constexpr double kClear = 4, kSeconds = 30;
/// Length of the only run of poor data, which do not separate confounded causes.
constexpr double kPoor = 3, kPoorSeconds = 12;
/// Largest amplitude of a credible crane / nominal amplitude.
constexpr double kMostAmplitude = 3;

/// An effect in data that do not separate it from its rival.
struct Alike {
  const char *name, *axis, *run;
};
constexpr std::array kAlike{Alike{"command_delay", "trolley", "moves"},
                            Alike{"swing_moving_average", "", "moves"},
                            Alike{"actuator_lag", "slew", "moves"},
                            Alike{"swing_delay", "", "moves"},
                            Alike{"command_offset", "trolley", "moves"},
                            Alike{"steady_wind", "", "small"},
                            Alike{"direction_asymmetry", "slew", "moves"},
                            Alike{"swing_offset", "radial", "small"},
                            Alike{"jib_tilt", "", "small"},
                            Alike{"stribeck_friction", "trolley", "moves"},
                            Alike{"position_dependent_friction", "slew", "moves"}};

truth::Case case_on(const std::string& rig, std::uint64_t seed) {
  truth::Case request;
  request.rig = rig;
  request.seed = seed;
  request.seconds = kSeconds;
  if (rig == "pendulum") request.training_runs = {"swing", "large"}, request.test_runs = {"swing"};
  return request;
}

/// Effects that data of a free pendulum cannot show: a late sensor is equivalent to a later release, a tilted
/// support to an offset, a rotated sensor to another direction of release.
bool shows_nowhere(const std::string& rig, const truth::Hidden& effect) {
  return rig == "pendulum" && (effect.name == "swing_delay" || effect.name == "swing_moving_average" ||
                               effect.name == "jib_tilt" || effect.name == "swing_misalignment");
}

bool possible(const std::string& rig, const std::vector<truth::Hidden>& effects) {
  if (std::any_of(effects.begin(), effects.end(), [&](const auto& e) { return shows_nowhere(rig, e); }))
    return false;
  truth::Case request = case_on(rig, 1);
  request.effects = effects;
  request.training_runs.resize(1);
  request.test_runs.clear();
  request.seconds = 0.05;
  try {
    (void)truth::generate(request);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// Scales the effects one by one to `multiple` detection limits.
/// @return the smallest multiple reached: bounds of the crane limit some effects
double set_amplitudes(truth::Case& request, double multiple) {
  constexpr double kTrial = 0.5;
  double reached = multiple;
  for (truth::Hidden& hidden : request.effects) {
    truth::Case alone = request;
    alone.effects = {{hidden.name, kTrial, hidden.axis}};
    alone.training_runs.resize(1);
    const double limit = kTrial / std::max(truth::effect_size(alone).ratio, 1e-6);
    hidden.amplitude = alone.effects[0].amplitude = std::min(multiple * limit, kMostAmplitude);
    reached = std::min(reached, truth::effect_size(alone).ratio);
  }
  return reached;
}

/// Largest multiple of the deck that the effect can have; 0: none.
double nearest_multiple(double reached) {
  constexpr double kNear = 0.75;
  for (const double multiple : kMultiples)
    if (reached >= kNear * multiple) return multiple;
  return 0;
}

/// Every second set is of the tower; the other sets are of the other rigs that can have the effects, in turn.
std::string rig_for(const std::vector<truth::Hidden>& effects, std::size_t turn) {
  constexpr std::array kRigs{"gantry", "drive_axis", "pendulum"};
  if (turn % 2 == 0) return "tower";
  for (std::size_t i = 0; i < kRigs.size(); ++i) {
    std::string rig = kRigs[(turn / 2 + i) % kRigs.size()];
    if (possible(rig, effects)) return rig;
  }
  return "tower";
}

std::vector<std::string> names(bool in_library) {
  std::vector<std::string> all;
  for (const truth::EffectKind& kind : truth::effect_kinds())
    if (kind.in_library == in_library) all.push_back(kind.name);
  return all;
}

/// Two causes that are not confounded.
std::vector<truth::Hidden> two(std::size_t count) {
  const auto all = names(true);
  const std::string& first = all[count * 5 % all.size()];
  for (std::size_t i = count * 11 + 3;; ++i) {
    const std::string& second = all[i % all.size()];
    if (second != first && !confounded(first, second)) return {{first, 1, ""}, {second, 1, ""}};
  }
}

}  // namespace

const char* name_of(Kind kind) {
  return std::array{"clean", "single", "outside", "pair", "confounded"}[static_cast<std::size_t>(kind)];
}

Set set_of(std::size_t number, std::uint64_t first_seed) {
  const std::size_t round = number / kPattern.size(), place = number % kPattern.size();
  Set set{number, kPattern[place], kClear, {}};
  const auto before = static_cast<std::size_t>(
      std::count(kPattern.begin(), kPattern.begin() + static_cast<std::ptrdiff_t>(place), set.kind));
  const auto each = static_cast<std::size_t>(std::count(kPattern.begin(), kPattern.end(), set.kind));
  const std::size_t count = round * each + before;  // number of earlier sets of this kind
  const std::uint64_t seed = first_seed + number;
  std::vector<truth::Hidden> effects;
  std::string rig;
  if (set.kind == Kind::single || set.kind == Kind::outside) {
    const auto all = names(set.kind == Kind::single);
    effects = {{all[count * (set.kind == Kind::single ? 5 : 1) % all.size()], 1, ""}};
    // All amplitudes of a cause in three rounds, balanced within a round.
    if (set.kind == Kind::single)
      set.multiple = kMultiples[(count % all.size() + count / all.size()) % kMultiples.size()];
    rig = rig_for(effects, count + count / all.size());
  } else if (set.kind == Kind::pair) {
    effects = two(count);
    rig = rig_for(effects, count);
  } else if (set.kind == Kind::confounded) {
    const Alike& alike = kAlike[count % kAlike.size()];
    effects = {{alike.name, 1, alike.axis}};
    set.request = case_on("tower", seed);
    set.request.training_runs = {alike.run, alike.run};
    set.request.test_runs = {alike.run};
    if (count % 2 == 1) {
      set.multiple = kPoor;
      set.request.seconds = kPoorSeconds;
      set.request.training_runs.resize(1);
    }
  } else {
    rig = rig_for({}, count);
    set.multiple = 0;
  }
  if (!rig.empty()) set.request = case_on(rig, seed);
  set.request.effects = effects;
  if (!effects.empty()) set.multiple = nearest_multiple(set_amplitudes(set.request, set.multiple));
  return set;
}

std::string run_like(const std::string& experiment) {
  const auto begins = [&](const char* with) { return experiment.starts_with(with); };
  if (begins("slow_sweep_slew") || begins("half_turn")) return "slew_180";
  if (begins("slow_sweep") || begins("two_speeds")) return "slow";
  if (begins("break_away")) return "rest_breakaway";
  if (begins("shaking")) return "rich";
  if (begins("load_swinging")) return "swing";
  if (begins("second_cable_length")) return "two_lengths";
  return "";  // the truth has no added mass
}

}  // namespace crane::diagnosis::score
