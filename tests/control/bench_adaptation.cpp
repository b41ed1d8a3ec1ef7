/// Figures of docs/adaptation.md.
///   bench_adaptation settle              settling of eight moves from wrong and from exact compensations
///   bench_adaptation random FIRST COUNT  random cranes from COUNT seeds: limit cycles, settling
#include <cstdio>
#include <cstdlib>
#include <string>

#include "adaptation_draw.hpp"

namespace crane::control::test {
namespace {

struct Row {
  const char* name;
  double positive, negative, stiction;  ///< factors of the compensated levels
  bool adapts;
};
constexpr std::array kRows{
    Row{"exact, fixed", 1, 1, 1, false},         Row{"exact", 1, 1, 1, true},
    Row{"all -20 %, fixed", 0.8, 0.8, 1, false}, Row{"all -20 %", 0.8, 0.8, 1, true},
    Row{"all +20 %, fixed", 1.2, 1.2, 1, false}, Row{"all +20 %", 1.2, 1.2, 1, true},
    Row{"+20 %, -20 %", 1.2, 0.8, 1, true},      Row{"-20 %, +20 %", 0.8, 1.2, 1, true},
    Row{"static -20 %", 1, 1, 0.8, true},        Row{"static +20 %", 1, 1, 1.2, true}};

void settle() {
  constexpr double kHalfPi = std::numbers::pi / 2;
  struct Case {
    const char* name;
    bool tower;
    Target from, to;
  };
  for (const Case& at :
       {Case{"maneuver 1", true, {0.25, 0}, {1, 0}}, Case{"maneuver 2", true, {0.9, 0}, {0.9, kHalfPi}},
        Case{"maneuver 3", true, {0.25, 0}, {1, kHalfPi}}, Case{"gantry", false, {0.25, 0}, {1, 0}}})
    for (const Row& row : kRows) {
      AdaptedRig rig = at.tower ? adapted_tower() : adapted_gantry();
      rig.design.adaptation.enabled = row.adapts;
      for (auto& f : rig.design.friction) {
        for (double* level : {&f.coulomb_positive_v, &f.viscous_positive_vspm}) *level *= row.positive;
        for (double* level : {&f.coulomb_negative_v, &f.viscous_negative_vspm}) *level *= row.negative;
        f.stiction_positive_v *= row.positive * row.stiction;
        f.stiction_negative_v *= row.negative * row.stiction;
      }
      AdaptedCrane crane{rig};
      crane.place(at.from.trolley_m, at.from.slew_rad, rig.design.cable_length_m);
      std::printf("%-11s %-17s", at.name, row.name);
      for (int i = 0; i < 8; ++i)
        std::printf(" %6.2f", crane.move(i % 2 == 0 ? at.to : at.from, 12).settled_s);
      std::printf("\n");
    }
}

void random(unsigned first, unsigned count) {
  int exact_cycles = 0, adapted_cycles = 0, settled = 0, close = 0, quiet = 0, quiet_close = 0;
  unsigned roll_backs = 0, detections = 0;
  for (unsigned seed = first; seed < first + count; ++seed) {
    const auto drawn = drawn_case(seed, 8);
    const auto exact = made_moves(drawn, drawn.exact, seed);
    const auto adapted = made_moves(drawn, drawn.wrong, seed, [&](const Adaptation& adaptation) {
      for (const auto& axis : adaptation.report().axis)
        roll_backs += axis.roll_backs, detections += axis.limit_cycles;
    });
    const bool exact_cycle = oscillates(drawn, exact);
    exact_cycles += exact_cycle;
    const bool cycle = oscillates(drawn, adapted);
    adapted_cycles += cycle;
    if (cycle) std::printf("seed %u oscillates%s\n", seed, exact_cycle ? ", also with the exact levels" : "");
    const bool calm = drawn.exact.noise_counts == 0 && drawn.exact.more_terms.empty() &&
                      drawn.moves.back().friction_factor == 1;
    for (std::size_t i = 5; i < 8; ++i) {
      const double fixed_s = exact.moves[i].settled_s;
      if (fixed_s <= 0 || fixed_s >= 10) continue;
      const bool within = adapted.moves[i].settled_s <= 1.05 * fixed_s + 0.005;  // half a tick
      ++settled, close += within;
      if (calm) ++quiet, quiet_close += within;
    }
  }
  std::printf(
      "%u cases: oscillate %d adapted, %d exact; moves 6 to 8 within 5 %% of exact: %d of %d, without noise, "
      "gusts and steps %d of %d; roll-backs %u, detected oscillations %u\n",
      count, adapted_cycles, exact_cycles, close, settled, quiet_close, quiet, roll_backs, detections);
}

}  // namespace
}  // namespace crane::control::test

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const auto number = [&](int i) { return static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)); };
  if (what == "settle")
    crane::control::test::settle();
  else if (what == "random" && argc == 4)
    crane::control::test::random(number(2), number(3));
  else
    return std::fputs("bench_adaptation settle | random FIRST COUNT\n", stderr), 2;
  return 0;
}
