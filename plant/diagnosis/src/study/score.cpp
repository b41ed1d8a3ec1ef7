#include "study/score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "force/position_spectrum.hpp"
#include "parallel.hpp"
#include "replay/standstill.hpp"
#include "replay/travel.hpp"
#include "study/design.hpp"
#include "study/min_p.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kWaves = 4;
constexpr std::size_t kStartShapes = 3;
constexpr std::array kStartShares{1.0, 0.4};

void judge(const Directions& d, Score& score) {
  const VectorXd total = d.by_block.colwise().sum().transpose();
  const VectorXd amounts = solve(d.curvature, total);
  score.amounts.assign(amounts.data(), amounts.data() + amounts.size());
  score.gain = d.one_sided && total[0] <= 0 ? 0 : std::max(0.0, total.dot(amounts));
  score.statistic = statistic_of(d);
  score.p_value = p_value_of(d, score.statistic);
}

const VectorXd& residual_of(const WindowFit& fit) { return fit.residual; }
const VectorXd& residual_of(const VectorXd& residual) { return residual; }

/// Decrease of the loss when `change` is subtracted from the residuals.
template <class Parts>
double gain_of(const Parts& parts, const std::vector<VectorXd>& change) {
  double gain = 0;
  for (std::size_t w = 0; w < change.size(); ++w)
    gain += loss_of(residual_of(parts[w])) - loss_of(residual_of(parts[w]) - change[w]);
  return gain;
}

/// The shapes with the largest predicted gain, either only those with a large probe or only those without.
std::vector<const Score*> most_promising(std::span<const Score> shapes, bool large_probe, std::size_t count) {
  std::vector<const Score*> order;
  for (const Score& score : shapes)
    if (score.shape.large_probe == large_probe && score.gain > 0) order.push_back(&score);
  std::sort(order.begin(), order.end(), [](const Score* a, const Score* b) { return a->gain > b->gain; });
  order.resize(std::min(order.size(), count));
  return order;
}

/// Best shape of a candidate. The slope at zero effect does not predict the gain of a large effect, least of
/// all for friction; a fit therefore has initial values from several shapes, with the whole predicted amount
/// or less.
Score best_shape(const Candidate& candidate, std::span<const Score> shapes) {
  Score best = *std::max_element(shapes.begin(), shapes.end(),
                                 [](const Score& a, const Score& b) { return a.gain < b.gain; });
  best.starts = candidate.ringing_starts;
  for (const Score* start : most_promising(shapes, true, 1))
    best.starts.push_back(candidate.begin(start->shape, start->amounts));
  for (const Score* start : most_promising(shapes, false, kStartShapes))
    for (const double share : kStartShares) {
      std::vector<double> amounts = start->amounts;
      for (double& amount : amounts) amount *= share;
      best.starts.push_back(candidate.begin(start->shape, amounts));
    }
  if (best.starts.empty()) best.starts.push_back(candidate.begin(best.shape, best.amounts));
  return best;
}

/// The friction retards the motion: sin(2 pi p / w + phi) = -cos(2 pi (p - p0) / w).
/// @param near  of the tight spots, the one nearest to this position is p0
Shape tight_spots_of(const Candidate& candidate, const PositionWave& wave, double near) {
  const double turns = -(wave.phase_rad + std::numbers::pi / 2) / (2 * std::numbers::pi);
  const double tight_at = near + std::remainder(turns * wave.period - near, wave.period);
  const FreeParameter& amplitude = candidate.parameters[0];
  return {{candidate.setting({amplitude.null + amplitude.step, wave.period, tight_at})}, {amplitude.step}};
}

}  // namespace

std::vector<Shape> shapes_of(const WhitenedData& data, const Candidate& candidate, const Effects& effects) {
  std::vector<Shape> shapes = candidate.shapes;
  if (!candidate.waves && !candidate.friction_waves) return shapes;
  const Output axis = candidate.drive_output();
  const plant::Parameters& rig = data.study().base().parameters;
  const double gain = axis == kTrolleyPosition ? rig.trolley_gain_mps2pv : rig.slew_gain_radps2pv;
  const Replays replays = replays_of(data.runs(), data.with(effects));
  const Pieces pieces = pieces_of(data.runs(), replays, axis);
  const WaveOf of = candidate.waves ? WaveOf::force : WaveOf::friction;
  const FreeParameter& length = candidate.parameters[candidate.waves ? 2 : 1];
  // On an axis at rest, the search finds waves of very short period; the bounds of the term exclude them.
  for (const PositionWave& wave : strongest_waves(pieces, kWaves, of)) {
    if (wave.period < length.low || wave.period > length.high) continue;
    if (candidate.waves)
      shapes.push_back(
          {{candidate.setting({wave.amplitude / gain, wave.phase_rad, wave.period})}, {1.0}, true});
    else
      shapes.push_back(tight_spots_of(candidate, wave, travel_of(data.runs(), axis).middle()));
  }
  return shapes;
}

namespace {

/// Every shape of every candidate that is not among the effects. Beside effects, a cause that adds a
/// natural frequency has the shape that was the strongest one for the base model.
std::vector<Score> places_of(const WhitenedData& data, const Effects& effects, const ProbeSlopes& known) {
  const std::vector<Candidate>& candidates = data.study().candidates();
  std::vector<std::vector<Shape>> shapes(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t c) {
    if (std::ranges::any_of(effects, [&](const Effect& e) { return e.candidate == &candidates[c]; })) return;
    // The score of a shape that rings needs an estimate of the starts of its inner coordinates.
    const Shape* strongest =
        candidates[c].ringing_starts_at && !effects.empty() ? known.strongest(c) : nullptr;
    shapes[c] = strongest != nullptr ? std::vector{*strongest} : shapes_of(data, candidates[c], effects);
  });
  std::vector<Score> all;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (Shape& shape : shapes[c])
      all.push_back({.candidate = c, .shape = std::move(shape), .amounts = {}, .starts = {}});
  return all;
}

/// What all probes of a score test have in common.
struct Probing {
  const WhitenedData& data;
  const Effects& effects;
  const Evaluation& at;
  PartVectors unmoved;  ///< plain residuals of the equation error of `at`
  ShowsIn unlike_base;  ///< parts in which the simulation differs from that of the base model
  const ProbeSlopes& known;
};

/// Appends the slopes of a probe with inner coordinates that the crane of `at` does not have, and whose
/// starts are free. @return decrease of the loss by these starts
double add_ringing(const WhitenedData& data, const Replays& crane, const Evaluation& at, double step,
                   ShowsIn parts, Slopes& slopes) {
  const Problem &drive = data.drive(), &load = data.load();
  const EquationError& equation_error = data.body().equation_error;
  double of_drive = 0, of_load = 0;
  const bool in_drive = parts.drive && !drive.empty();
  const bool in_load = parts.load && !load.empty();
  slopes.drive.push_back(in_drive ? drive.change(crane, at.drive, step, &of_drive) : PartVectors{});
  slopes.equation_error.push_back(in_drive ? equation_error.change(crane, at.equation_error, step)
                                           : PartVectors{});
  slopes.load.push_back(in_load ? load.change(crane, at.load, step, &of_load) : PartVectors{});
  return of_drive + of_load;
}

/// Appends the changes of the residuals by the probes of a candidate's shape.
/// @param fresh  receives slopes that were not known
/// @return decrease of the loss by free starts of the inner coordinates of the candidate
double add_probes(const Probing& probing, const Score& place, Slopes& slopes,
                  std::vector<ProbeSlopes::Known>& fresh) {
  const WhitenedData& data = probing.data;
  double own = 0;
  const Shape& shape = place.shape;
  const Candidate& candidate = data.study().candidates()[place.candidate];
  // A probe far from zero describes a rough effect in the load but not in the drives.
  const ShowsIn parts{candidate.drive && (!candidate.rough || data.load().empty()), candidate.load};
  const Evaluation& at = probing.at;
  Slopes plain;
  for (std::size_t p = 0; p < shape.probes.size(); ++p) {
    const ProbeSlopes::Known* known = probing.known.find(place.candidate, shape.probes[p]);
    const bool drive_known = known != nullptr && known->drive && !probing.unlike_base.drive;
    const bool load_known = known != nullptr && known->load && !probing.unlike_base.load;
    const ShowsIn missing{parts.drive && !drive_known, parts.load && !load_known};
    PlainSlope slope;
    if (missing.drive || missing.load) {
      Crane crane = data.with(probing.effects);
      crane.terms.push_back(shape.probes[p]);
      const Replays replays = replays_of(data.runs(), holding(crane));
      if (data.drive().has_other_coordinates(replays, at.drive) ||
          data.load().has_other_coordinates(replays, at.load)) {
        own += add_ringing(data, replays, at, shape.amounts[p], parts, slopes);
        continue;
      }
      slope = data.plain_slope(replays, at, shape.amounts[p], missing, probing.unmoved);
    }
    ProbeSlopes::Known& now = fresh.emplace_back(ProbeSlopes::Known{shape.probes[p], {}, {}});
    if (missing.drive && !probing.unlike_base.drive)
      now.drive = ProbeSlopes::Drive{slope.drive, slope.equation_error};
    if (missing.load && !probing.unlike_base.load) now.load = slope.load;
    if (parts.drive && drive_known)
      slope.drive = known->drive->windows, slope.equation_error = known->drive->equation_error;
    if (parts.load && load_known) slope.load = *known->load;
    plain.push_back(std::move(slope));
  }
  slopes.append(data.whitened(plain, at));
  return own;
}

/// Smallest visible amount of each candidate. @param slopes  by place, of its probes
std::vector<Visibility> excitation(const WhitenedData& data, const std::vector<Score>& places,
                                   const std::vector<Slopes>& slopes, const Evaluation& at) {
  std::vector<std::vector<double>> information;
  for (const Slopes& of_place : slopes) {
    std::vector<double>& own = information.emplace_back(of_place.drive.size(), 0.0);
    for (std::size_t probe = 0; probe < own.size(); ++probe)
      for (const auto* part :
           {&of_place.drive[probe], &of_place.equation_error[probe], &of_place.load[probe]})
        for (const VectorXd& change : *part) own[probe] += change.squaredNorm();
  }
  const std::vector<Direction> directions = strongest_directions(places, information);
  Slopes all;
  for (const Direction& d : directions) {
    all.drive.push_back(slopes[d.place].drive[d.probe]);
    all.equation_error.push_back(slopes[d.place].equation_error[d.probe]);
    all.load.push_back(slopes[d.place].load[d.probe]);
  }
  return visibility_of(data.study().candidates(), places, directions, data.scores(at, all));
}

}  // namespace

ScoreTable score_test(const WhitenedData& data, const Effects& effects, const Evaluation& at,
                      std::uint64_t seed, ProbeSlopes& probe_slopes) {
  const std::vector<Candidate>& candidates = data.study().candidates();
  std::vector<Score> scores = places_of(data, effects, probe_slopes);
  const Slopes known = data.whitened(data.plain_slopes(effects, at), at);
  const Probing probing{
      data,
      effects,
      at,
      data.body().equation_error.plain_residuals(replays_of(data.runs(), data.with(effects))),
      unlike(data.body(), effects, at, probe_slopes.base()),
      probe_slopes};
  std::vector<std::vector<ProbeSlopes::Known>> fresh(scores.size());
  std::vector<Directions> directions(scores.size());
  std::vector<Slopes> kept(effects.empty() ? scores.size() : 0);
  parallel_for(scores.size(), [&](std::size_t i) {
    Slopes all = known;
    const double own = add_probes(probing, scores[i], all, fresh[i]);
    const auto own_directions = static_cast<Index>(all.size() - known.size());
    directions[i] = beside_known(data.scores(at, all), own_directions);
    const Candidate& candidate = candidates[scores[i].candidate];
    const bool large_probe = scores[i].shape.large_probe;
    directions[i].one_sided = candidate.one_sided || large_probe;
    judge(directions[i], scores[i]);
    if (large_probe)
      scores[i].gain = gain_of(at.drive, all.drive.back()) + gain_of(at.load, all.load.back()) +
                       gain_of(at.equation_error, all.equation_error.back());
    scores[i].gain += own;
    const double loss = (candidate.drive ? at.drive_loss : 0) + (candidate.load ? at.load_loss : 0);
    scores[i].share = loss > 0 ? scores[i].gain / loss : 0;
    if (effects.empty()) kept[i] = std::move(all);
  });
  for (std::size_t i = 0; i < scores.size(); ++i)
    for (ProbeSlopes::Known& of_probe : fresh[i]) probe_slopes.keep(scores[i].candidate, std::move(of_probe));
  ScoreTable table;
  if (effects.empty()) probe_slopes.keep_base(simulation_of(at));
  if (effects.empty()) table.excitation = excitation(data, scores, kept, at);
  double least = 1;
  for (const Score& score : scores) least = std::min(least, score.p_value);
  table.p_value = p_value_of_smallest(directions, least, seed);
  for (auto first = scores.begin(); first != scores.end();) {
    const auto end = std::find_if(first, scores.end(),
                                  [&](const Score& score) { return score.candidate != first->candidate; });
    table.best.push_back(best_shape(candidates[first->candidate], {first, end}));
    if (effects.empty()) probe_slopes.keep_strongest(first->candidate, table.best.back().shape);
    first = end;
  }
  return table;
}

}  // namespace crane::diagnosis
