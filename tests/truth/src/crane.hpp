#pragma once
/// The moving crane: drives, friction, elastic connections, gaps, disturbances and sensors. The integrator is
/// a Runge-Kutta method of fourth order with steps of 0.4 ms between the edges of the (delayed) command.
#include <cstdint>
#include <string>
#include <vector>

#include "bristles.hpp"
#include "mechanics.hpp"
#include "random.hpp"
#include "truth/physics.hpp"

namespace truth {

inline constexpr double kTick_s = 0.01;
inline constexpr double kStep_s = 0.0004;

/// Disturbance and noise, drawn from the seed; 0: none.
struct Disturbance {
  double drive_v = 0;  ///< rms of the coloured disturbance at each motor
  double load_n = 0;   ///< rms of the coloured force on the load, per direction
  double correlation_s = 0.5;
  double noise_counts = 0;  ///< rms of white noise before the encoders round
  bool quantised = true;    ///< encoders and converter
};

struct Start {
  double trolley_m = 0, slew_rad = 0, radial_rad = 0, tangential_rad = 0;
};

/// Trolley, slew, radial, tangential.
using Sensed = std::array<double, 4>;
using Volts = std::array<double, kDrives>;

inline double along(double share, double from, double to) { return from + share * (to - from); }

class Crane {
 public:
  /// @param run names the streams of random numbers, with the seed
  Crane(const Physics& physics, const Disturbance& disturbance, const Start& start, std::uint64_t seed,
        const std::string& run);

  /// Advances by one tick with a constant command.
  void advance(const Volts& command_v);
  /// Present sensor values without noise and rounding.
  [[nodiscard]] Sensed sense() const;
  /// Present sensor values with noise and rounding; call once per tick.
  [[nodiscard]] Sensed measure();
  /// Output of the converter for a command.
  [[nodiscard]] Volts converted(const Volts& command_v) const;

  /// A copy of the crane in its present state with other parameters, except the cable, and without further
  /// disturbance.
  [[nodiscard]] Crane without_effects(Physics nominal) const;
  [[nodiscard]] Crane undisturbed() const;

  [[nodiscard]] double energy_j() const;
  [[nodiscard]] const Coordinates& position() const { return now_.q; }
  [[nodiscard]] const Coordinates& rate() const { return now_.rate; }
  void set_rate(Coordinate c, double rate) { now_.rate[mechanics_.of(c)] = rate; }

 private:
  struct Moving {
    Coordinates q{}, rate{};
    std::array<double, kDrives> lag_1{}, lag_2{}, hysteresis{};
  };
  struct Past {
    double time_s, radial_rad, tangential_rad;
  };
  struct Span {
    double from_s = 0, to_s = 0;
  };
  static Moving stepped(const Moving& at, double span_s, const Moving& slope);
  [[nodiscard]] std::vector<double> edges(double end_s) const;
  [[nodiscard]] Volts delayed(double time_s) const;
  [[nodiscard]] double amplifier(std::size_t axis, const Volts& command_v, double time_s) const;
  [[nodiscard]] double friction_level(std::size_t axis, double position, double speed, double time_s) const;
  [[nodiscard]] double drive_v(std::size_t axis, const Moving& at, double input_v, double time_s) const;
  [[nodiscard]] double connection(std::size_t axis, double apart, double parting) const;
  void add_connections(const Moving& at, Acting& acting) const;
  [[nodiscard]] Vector load_force(const Moving& at, double time_s) const;
  [[nodiscard]] Moving slope(const Moving& at, const Volts& input_v, double time_s) const;
  void run(double span_s, const Volts& input_v);
  void advance_bristles(double span_s);
  void remember();
  void slip();
  [[nodiscard]] std::array<double, 2> swing_at(double time_s) const;
  [[nodiscard]] double within_tick(double time_s) const { return (time_s - tick_start_s_) / kTick_s; }

  Physics physics_;
  Mechanics mechanics_;
  Disturbance disturbance_;
  Moving now_;
  double time_s_ = 0, tick_start_s_ = 0;
  std::vector<Volts> commands_v_;
  std::array<Bristles, kDrives> drive_bristles_, driven_bristles_, pivot_bristles_;

  Random noise_, slips_;
  std::vector<Coloured> coloured_;  ///< drives, wind x and y, air x and y
  std::array<double, 6> before_{}, after_{};
  std::vector<Span> dragging_;
  std::array<double, kDrives> slipped_{};
  std::vector<Past> past_;
};

}  // namespace truth
