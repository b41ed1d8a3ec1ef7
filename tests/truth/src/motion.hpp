#pragma once
/// Task of a run: references in closed loop, or voltages that rise until an axis breaks away.
#include <string>
#include <string_view>
#include <vector>

#include "crane.hpp"

namespace truth {

struct Target {
  double position = 0, speed = 0, acceleration = 0;
};

/// Moves from point to point, with sines around them.
class Reference {
 public:
  explicit Reference(double start) : end_(start), start_(start) {}
  /// Moves to `position` from `at_s` on with a mean speed of at most `speed`; acceleration and deceleration
  /// last `round_s`.
  void move(double at_s, double position, double duration_s, double round_s);
  void sine(double amplitude, double frequency_hz, double phase_rad);
  [[nodiscard]] double end() const { return end_; }
  [[nodiscard]] Target at(double time_s) const;

 private:
  struct Move {
    double at_s, from, to, duration_s, round_s;
  };
  struct Sine {
    double amplitude, omega, phase;
  };
  std::vector<Move> moves_;
  std::vector<Sine> sines_;
  double end_, start_;
};

struct Plan {
  std::array<Reference, kDrives> reference{Reference{0}, Reference{0}};
  Start start;
  double seconds = 0;
  double cable_m = 1;
  double swing_damping = 0.4;  ///< k, m/s2 of the trolley per rad/s of swing
  bool break_away = false;     ///< voltage ramps instead of references
};

/// @param kind one of run_kinds(); @throws std::invalid_argument when the rig cannot do it
[[nodiscard]] Plan plan(const Physics& physics, std::string_view kind, double seconds, Random random);

}  // namespace truth
