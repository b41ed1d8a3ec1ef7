#include "search/compare.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

namespace crane::diagnosis {
namespace {

/// Held-out data are fewer: they have to agree, not to prove it alone.
constexpr double kHeldOutWin = 0.95;
/// So do those that are too few to prove anything.
constexpr double kHeldOutAgrees = 0.5;
/// What improves the loss of neither drives nor load by such a share is of no consequence for the
/// crane. Friction is no law as exact as a pendulum's.
constexpr double kLeastDriveShare = 0.012, kLeastLoadShare = 0.007;
/// A term's form is not exactly the effect's: beside it, another one on the same axis that takes less than
/// this share of what it explains may only make up for that.
constexpr double kLeastBeside = 0.01;
/// What explains less of the training data than such a share of what another one does, does not do as well.
constexpr double kAsMuch = 0.9;
constexpr int kVotes = 500;

/// Of one parameter, in units of one noise variance: that of the Bayesian information criterion.
double price(const Fitted& f) { return std::log(static_cast<double>(blocks(f))); }

double total(const Fitted& f) { return f.train.loss + f.test.loss; }

/// What a hypothesis is judged by: training and held-out loss together with a price for its parameters.
double value(const Fitted& f) { return total(f) + price(f) * static_cast<double>(f.parameters); }

/// The axis whose motion a cause changes: the swing's direction goes with the drive that excites it.
std::string_view direction_of(const Candidate& candidate) {
  if (candidate.axis == "radial") return "trolley";
  return candidate.axis == "tangential" ? "slew" : std::string_view{candidate.axis};
}

/// Whether something that only `fitted` has acts where `before` has something too.
bool shares_axis(const Fitted& fitted, const Fitted& before) {
  return std::any_of(fitted.effects.begin(), fitted.effects.end(), [&](const Effect& added) {
    return !has(before.effects, added.candidate) &&
           std::any_of(before.effects.begin(), before.effects.end(), [&](const Effect& there) {
             return direction_of(*there.candidate) == direction_of(*added.candidate);
           });
  });
}

/// Whether what `fitted` explains beyond `before` is as little as a wrong form may leave, in either data.
bool makes_up_for_a_form(const Fitted& fitted, const Fitted& before, const Fitted& base) {
  const auto little = [](double now, double then, double bare) {
    return then - now < kLeastBeside * (bare - then);
  };
  return little(fitted.train.loss, before.train.loss, base.train.loss) ||
         little(fitted.test.loss, before.test.loss, base.test.loss);
}

/// Whether the loss of drives or load is less by a share that matters for the crane.
bool matters(const Evaluation& now, const Evaluation& old) {
  return now.loss < old.loss && (old.drive_loss - now.drive_loss > kLeastDriveShare * old.drive_loss ||
                                 old.load_loss - now.load_loss > kLeastLoadShare * old.load_loss);
}

/// No block outvotes the others: an axis that slips earlier or later once makes as much of one as an effect
/// of all of them. Twice what all but a twentieth keep to is the most that counts.
void limit(std::vector<double>& differences) {
  if (differences.empty()) return;
  std::vector<double> sizes;
  sizes.reserve(differences.size());
  for (const double difference : differences) sizes.push_back(std::abs(difference));
  const auto usual = sizes.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), usual, sizes.end());
  for (double& difference : differences) difference = std::clamp(difference, -2 * *usual, 2 * *usual);
}

/// Shares of resamples of all blocks in which `f` is better than `before`: in all, in the held-out ones.
struct Wins {
  double all = 0, held_out = 0;
};

Wins block_wins(const Fitted& f, const Fitted& before, std::uint64_t seed) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < f.train.blocks.size(); ++i)
    difference.push_back(before.train.blocks[i] - f.train.blocks[i]);
  const std::size_t training = difference.size();
  for (std::size_t i = 0; i < f.test.blocks.size(); ++i)
    difference.push_back(before.test.blocks[i] - f.test.blocks[i]);
  limit(difference);
  const double extra =
      price(f) * (static_cast<double>(f.parameters) - static_cast<double>(before.parameters));
  std::mt19937_64 random(seed);
  Wins wins;
  for (int i = 0; i < kVotes; ++i) {
    double all = -extra, held_out = 0;
    for (std::size_t k = 0; k < difference.size(); ++k) {
      const std::size_t at = static_cast<std::size_t>(random() % difference.size());
      all += difference[at];
      if (at >= training) held_out += difference[at];
    }
    wins.all += all > 0 ? 1.0 / kVotes : 0;
    wins.held_out += f.test.blocks.empty() || held_out > 0 ? 1.0 / kVotes : 0;
  }
  return wins;
}

}  // namespace

bool has(const Effects& effects, const Candidate* candidate) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const Effect& e) { return e.candidate == candidate; });
}

std::string label_of(const Effects& effects) {
  std::string label;
  for (const Effect& effect : effects) label += (label.empty() ? "" : " + ") + effect.candidate->label();
  return label;
}

std::size_t blocks(const Fitted& f) { return f.train.blocks.size() + f.test.blocks.size(); }

bool less(const Fitted& a, const Fitted& b) { return value(a) < value(b); }

bool same(const Effects& a, const Effects& b) {
  return a.size() == b.size() &&
         std::all_of(a.begin(), a.end(), [&](const Effect& e) { return has(b, e.candidate); });
}

bool accepted(const Fitted& fitted, const Fitted& before, const Fitted& base, std::uint64_t seed) {
  if (!matters(fitted.train, before.train)) return false;
  if (shares_axis(fitted, before) && makes_up_for_a_form(fitted, before, base)) return false;
  const Wins wins = block_wins(fitted, before, seed);
  return wins.all > 1 - kSignificant && wins.held_out > kHeldOutWin;
}

bool likely(const Fitted& fitted, const Fitted& base, std::uint64_t seed) {
  if (!matters(fitted.train, base.train) && !matters(fitted.test, base.test)) return false;
  const Wins wins = block_wins(fitted, base, seed);
  return wins.all > 1 - kSignificant && wins.held_out > kHeldOutAgrees;
}

bool possible(const Fitted& fitted, const Fitted& base, std::uint64_t seed) {
  return block_wins(fitted, base, seed).all > 1 - kSignificant;
}

namespace {

/// Parts in which what `a` has and `b` has not shows.
ShowsIn only_in(const Fitted& a, const Fitted& b) {
  ShowsIn parts;
  for (const Effect& e : a.effects) {
    const bool shared = has(b.effects, e.candidate);
    parts.drive = parts.drive || (!shared && e.candidate->drive);
    parts.load = parts.load || (!shared && e.candidate->load);
  }
  return parts;
}

/// What `rival` does better block by block in the parts where it would have to replace what only `best` has.
std::vector<double> advantage(const Fitted& rival, const Fitted& best) {
  const ShowsIn parts = only_in(best, rival);
  std::vector<double> margins;
  for (const auto& [of_best, of_rival] : {std::pair{&best.train, &rival.train}, {&best.test, &rival.test}})
    for (std::size_t i = 0; i < of_best->blocks.size(); ++i) {
      const bool counts = i < of_best->drive_blocks ? parts.drive : parts.load;
      margins.push_back(counts ? of_best->blocks[i] - of_rival->blocks[i] : 0);
    }
  limit(margins);
  return margins;
}

/// Whether in training it comes as near to `best` as to be told from it only by what more parameters make of
/// a form that is not exactly the effect's.
bool explains_as_much(const Fitted& rival, const Fitted& best, const Fitted& base) {
  return base.train.loss - rival.train.loss > kAsMuch * (base.train.loss - best.train.loss);
}

}  // namespace

std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                const Fitted& base, std::uint64_t seed) {
  std::vector<std::vector<double>> margins;
  margins.reserve(rivals.size());
  for (const Fitted* rival : rivals) margins.push_back(advantage(*rival, best));
  std::vector<double> picked(rivals.size(), 0.0);
  std::mt19937_64 random(seed + 17);
  const std::size_t count = blocks(best), training = best.train.blocks.size();
  for (int i = 0; i < kVotes; ++i) {
    std::vector<double> total(rivals.size()), held_out(rivals.size(), 0.0);
    for (std::size_t r = 0; r < rivals.size(); ++r)
      total[r] =
          price(best) * (static_cast<double>(best.parameters) - static_cast<double>(rivals[r]->parameters));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = static_cast<std::size_t>(random() % count);
      for (std::size_t r = 0; r < rivals.size(); ++r) {
        total[r] += margins[r][at];
        if (at >= training) held_out[r] += margins[r][at];
      }
    }
    for (std::size_t r = 0; r < rivals.size(); ++r)
      if (rivals[r]->parameters < best.parameters && explains_as_much(*rivals[r], best, base))
        total[r] = std::max(total[r], held_out[r]);
    const auto winner = std::max_element(total.begin(), total.end());
    if (winner != total.end() && *winner > 0)
      picked[static_cast<std::size_t>(winner - total.begin())] += 1.0 / kVotes;
  }
  return picked;
}

namespace {

/// "m/s or rad/s" is one of both where the axis is known.
std::string unit_on(const std::string& axis, const std::string& unit) {
  const std::size_t either = unit.find(" or ");
  if (either == std::string::npos || (axis != "trolley" && axis != "slew")) return unit;
  return axis == "trolley" ? unit.substr(0, either) : unit.substr(either + 4);
}

}  // namespace

std::vector<Estimate> estimates(const Fitted& f) {
  std::vector<Estimate> all;
  std::size_t i = 0;
  for (const Effect& effect : f.effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
      all.push_back({effect.candidate->parameters[k].name,
                     unit_on(effect.candidate->axis, effect.candidate->parameters[k].unit), effect.values[k],
                     f.std_dev[i]});
  return all;
}

}  // namespace crane::diagnosis
