#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "force/position_spectrum.hpp"
#include "parallel.hpp"
#include "replay/standstill.hpp"
#include "replay/travel.hpp"
#include "study/blocks.hpp"
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

std::vector<Shape> Study::shapes_of(const Candidate& candidate, const Effects& effects) const {
  std::vector<Shape> shapes = candidate.shapes;
  if (!candidate.waves && !candidate.friction_waves) return shapes;
  const Output axis = candidate.drive_output();
  const double gain =
      axis == kTrolleyPosition ? base_.parameters.trolley_gain_mps2pv : base_.parameters.slew_gain_radps2pv;
  const Replays replays = replays_of(train_.runs, with(effects));
  const Pieces pieces = pieces_of(train_.runs, replays, axis);
  const WaveOf of = candidate.waves ? WaveOf::force : WaveOf::friction;
  const FreeParameter& length = candidate.parameters[candidate.waves ? 2 : 1];
  // On an axis at rest, the search finds waves of very short period; the bounds of the term exclude them.
  for (const PositionWave& wave : strongest_waves(pieces, kWaves, of)) {
    if (wave.period < length.low || wave.period > length.high) continue;
    if (candidate.waves)
      shapes.push_back(
          {{candidate.setting({wave.amplitude / gain, wave.phase_rad, wave.period})}, {1.0}, true});
    else
      shapes.push_back(tight_spots_of(candidate, wave, travel_of(train_.runs, axis).middle()));
  }
  return shapes;
}

std::vector<Score> Study::places(const Effects& effects, const ProbeSlopes& known) const {
  std::vector<std::vector<Shape>> shapes(candidates_.size());
  parallel_for(candidates_.size(), [&](std::size_t c) {
    if (std::ranges::any_of(effects, [&](const Effect& e) { return e.candidate == &candidates_[c]; })) return;
    // The score of a shape that rings needs an estimate of the starts of its inner coordinates.
    const Shape* strongest =
        candidates_[c].ringing_starts_at && !effects.empty() ? known.strongest(c) : nullptr;
    shapes[c] = strongest != nullptr ? std::vector{*strongest} : shapes_of(candidates_[c], effects);
  });
  std::vector<Score> all;
  for (std::size_t c = 0; c < candidates_.size(); ++c)
    for (Shape& shape : shapes[c])
      all.push_back({.candidate = c, .shape = std::move(shape), .amounts = {}, .starts = {}});
  return all;
}

/// What all probes of a score test have in common.
struct Study::Probing {
  const Effects& effects;
  const Evaluation& at;
  PartVectors unmoved;  ///< plain residuals of the equation error of `at`
  ShowsIn unlike_base;  ///< parts in which the simulation differs from that of the base model
  const ProbeSlopes& known;
};

double Study::add_ringing(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                          Slopes& slopes) const {
  double of_drive = 0, of_load = 0;
  const bool in_drive = parts.drive && !train_.drive.empty();
  const bool in_load = parts.load && !train_.load.empty();
  slopes.drive.push_back(in_drive ? train_.drive.change(crane, at.drive, step, &of_drive) : PartVectors{});
  slopes.equation_error.push_back(in_drive ? train_.equation_error.change(crane, at.equation_error, step)
                                           : PartVectors{});
  slopes.load.push_back(in_load ? train_.load.change(crane, at.load, step, &of_load) : PartVectors{});
  return of_drive + of_load;
}

double Study::add_probes(const Probing& probing, const Score& place, Slopes& slopes,
                         std::vector<ProbeSlopes::Known>& fresh) const {
  double own = 0;
  const Shape& shape = place.shape;
  const Candidate& candidate = candidates_[place.candidate];
  // A probe far from zero describes a rough effect in the load but not in the drives.
  const ShowsIn parts{candidate.drive && (!candidate.rough || train_.load.empty()), candidate.load};
  const Evaluation& at = probing.at;
  Slopes plain;
  for (std::size_t p = 0; p < shape.probes.size(); ++p) {
    const ProbeSlopes::Known* known = probing.known.find(place.candidate, shape.probes[p]);
    const bool drive_known = known != nullptr && known->drive && !probing.unlike_base.drive;
    const bool load_known = known != nullptr && known->load && !probing.unlike_base.load;
    const ShowsIn missing{parts.drive && !drive_known, parts.load && !load_known};
    PlainSlope slope;
    if (missing.drive || missing.load) {
      Crane crane = with(probing.effects);
      crane.terms.push_back(shape.probes[p]);
      const Replays replays = replays_of(train_.runs, holding(crane));
      if (train_.drive.has_other_coordinates(replays, at.drive) ||
          train_.load.has_other_coordinates(replays, at.load)) {
        own += add_ringing(replays, at, shape.amounts[p], parts, slopes);
        continue;
      }
      slope = plain_slope(replays, at, shape.amounts[p], missing, probing.unmoved);
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
  slopes.append(whitened(plain, at));
  return own;
}

std::vector<Visibility> Study::excitation(const std::vector<Score>& places, const std::vector<Slopes>& slopes,
                                          const Evaluation& at) const {
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
  return visibility_of(candidates_, places, directions, block_scores(at, all));
}

ScoreTable Study::score(const Effects& effects, const Evaluation& at, std::uint64_t seed,
                        ProbeSlopes& probe_slopes) const {
  std::vector<Score> scores = places(effects, probe_slopes);
  const Slopes known = slopes(effects, at);
  const Probing probing{effects, at,
                        train_.equation_error.plain_residuals(replays_of(train_.runs, with(effects))),
                        unlike_base(effects, at), probe_slopes};
  std::vector<std::vector<ProbeSlopes::Known>> fresh(scores.size());
  std::vector<Directions> directions(scores.size());
  std::vector<Slopes> kept(effects.empty() ? scores.size() : 0);
  parallel_for(scores.size(), [&](std::size_t i) {
    Slopes all = known;
    const double own = add_probes(probing, scores[i], all, fresh[i]);
    const auto own_directions = static_cast<Index>(all.drive.size() - known.drive.size());
    directions[i] = beside_known(block_scores(at, all), own_directions);
    const Candidate& candidate = candidates_[scores[i].candidate];
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
  if (effects.empty()) table.excitation = excitation(scores, kept, at);
  double least = 1;
  for (const Score& score : scores) least = std::min(least, score.p_value);
  table.p_value = p_value_of_smallest(directions, least, seed);
  for (auto first = scores.begin(); first != scores.end();) {
    const auto end = std::find_if(first, scores.end(),
                                  [&](const Score& score) { return score.candidate != first->candidate; });
    table.best.push_back(best_shape(candidates_[first->candidate], {first, end}));
    if (effects.empty()) probe_slopes.keep_strongest(first->candidate, table.best.back().shape);
    first = end;
  }
  return table;
}

}  // namespace crane::diagnosis
