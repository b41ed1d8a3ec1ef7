#pragma once
/// Random cranes and moves for the adaptation: every value is drawn from one seed.
#include "adapted_crane.hpp"

namespace crane::control::test {

struct DrawnMove {
  Target target;
  double kick_radps = 0;       ///< on the load, at the start of the move
  double friction_factor = 1;  ///< of the true friction from this move on, relative to the first move
};

struct DrawnCase {
  AdaptedRig exact;  ///< the compensation has the true Coulomb and viscous levels
  AdaptedRig wrong;  ///< the same crane; every level of the compensation is wrong by up to 20 %
  Target start;
  double cable_m = 1;
  std::vector<DrawnMove> moves;
};

inline DrawnCase drawn_case(unsigned seed, int moves) {
  std::mt19937 random{seed};
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  const bool tower = within(0, 1) < 0.6;
  DrawnCase drawn;
  AdaptedRig rig = tower ? adapted_tower() : adapted_gantry();
  drawn.cable_m = rig.design.cable_length_m;
  for (auto& f : rig.true_friction) {
    const double excess = within(0, 1) < 0.5 ? 1 : within(1, 1.4);
    f.stiction_positive_v *= excess;
    f.stiction_negative_v *= excess;
  }
  rig.truth.load_mass_kg *= within(0.5, 1.5);
  rig.truth.trolley_gain_mps2pv *= within(0.95, 1.05);
  rig.truth.slew_gain_radps2pv *= within(0.95, 1.05);
  rig.cable_offset_m = within(-0.2, 0.2) * drawn.cable_m;
  rig.noise_counts = within(0, 1) < 0.5 ? 0 : within(0, 2.9);  // up to ten times the rounding of an encoder
  for (auto& offset : rig.swing_offset_rad) offset = within(-0.005, 0.005);
  if (within(0, 1) < 0.3)
    rig.more_terms.push_back({"wind_gust",
                              "",
                              {{"coefficient_ns2pm2", within(0.002, 0.02)},
                               {"mean_mps", within(1, 5)},
                               {"scatter_mps", within(0, 2)},
                               {"length_m", 20},
                               {"direction_rad", within(-3, 3)},
                               {"seed", std::floor(within(1, 1e5))}}});
  drawn.exact = drawn.wrong = rig;
  for (auto& f : drawn.wrong.design.friction)
    for (double* level : {&f.viscous_positive_vspm, &f.viscous_negative_vspm, &f.coulomb_positive_v,
                          &f.coulomb_negative_v, &f.stiction_positive_v, &f.stiction_negative_v})
      *level *= within(0.8, 1.2);
  drawn.exact.design.adaptation.enabled = false;
  const auto target = [&] { return Target{within(0.3, 1.1), tower ? within(-1.2, 1.2) : 0}; };
  drawn.start = target();
  const double factor = within(0, 1) < 0.2 ? within(0.75, 1.25) : 1;
  const int from = static_cast<int>(within(2, moves - 2));
  for (int i = 0; i < moves; ++i)
    drawn.moves.push_back({.target = target(),
                           .kick_radps = within(0, 1) < 0.1 ? within(-0.3, 0.3) : 0,
                           .friction_factor = i >= from ? factor : 1});
  return drawn;
}

struct DrawnResult {
  std::vector<MoveResult> moves;
  MoveResult rest;  ///< after the moves: wind and noise end, the crane holds its position
};

/// Makes the drawn moves with one of the rigs of a case.
inline DrawnResult made_moves(const DrawnCase& drawn, const AdaptedRig& rig, unsigned seed,
                              const std::function<void(const Adaptation&)>& look = {}) {
  AdaptedCrane crane{rig, seed};
  crane.place(drawn.start.trolley_m, drawn.start.slew_rad, drawn.cable_m);
  const auto friction = rig.true_friction;
  DrawnResult result;
  for (const auto& move : drawn.moves) {
    crane.change([&](AdaptedRig& changed) {
      for (std::size_t i = 0; i < kAxes; ++i) {
        DriveFriction f = friction[i];
        for (double* level : {&f.viscous_positive_vspm, &f.viscous_negative_vspm, &f.coulomb_positive_v,
                              &f.coulomb_negative_v, &f.stiction_positive_v, &f.stiction_negative_v})
          *level *= move.friction_factor;
        changed.true_friction[i] = f;
      }
    });
    crane.kick(move.kick_radps, 0);
    result.moves.push_back(crane.move(move.target, 10));
  }
  crane.change([](AdaptedRig& changed) {
    changed.noise_counts = 0;
    changed.more_terms.clear();
  });
  result.rest = crane.move(drawn.moves.back().target, 10);
  if (look) look(crane.adaptation());
  return result;
}

/// Smallest number of reversals within the last 4 s of a move that counts as an oscillation.
inline constexpr int kCycle = 6;

/// True when the crane oscillates at rest without wind and noise, or, in a case without wind and noise, at
/// the end of one of the moves from the sixth on.
inline bool oscillates(const DrawnCase& drawn, const DrawnResult& result) {
  bool found = result.rest.late_reversals >= kCycle;
  if (drawn.exact.noise_counts == 0 && drawn.exact.more_terms.empty())
    for (std::size_t i = 5; i < result.moves.size(); ++i)
      found = found || result.moves[i].late_reversals >= kCycle;
  return found;
}

}  // namespace crane::control::test
