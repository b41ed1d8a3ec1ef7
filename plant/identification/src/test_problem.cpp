#include "crane/identification/test_problem.hpp"

#include <cmath>
#include <numbers>

namespace crane::identification {
namespace {

double reference_m(double time_s) {  // (3.18) of H. M. Omar, Control of Gantry and Tower Cranes
  using std::numbers::pi;
  return 0.3 * std::sin(pi / 2 * time_s) - 0.4 * std::sin(2 * pi / 3 * time_s);
}

class Simulation {
 public:
  explicit Simulation(const TestProblem& problem) : p_{problem} {}

  AxisRun run() {
    const auto samples = static_cast<std::size_t>(std::llround(p_.duration_s / p_.period_s)) + 1;
    AxisRun result;
    result.period_s = p_.period_s;
    for (std::size_t k = 0; k < samples; ++k) {
      time_s_ = static_cast<double>(k) * p_.period_s;
      held_v_ = continuous_v(time_s_, state_);
      result.position.push_back(state_.position);
      result.speed.push_back(state_.speed);
      result.drive_v.push_back(held_v_);
      constexpr int kSteps = 20;  // steps of 0.5 ms; the error of RK4 is then rounding error
      for (int i = 0; i < kSteps; ++i) advance(p_.period_s / kSteps);
    }
    return result;
  }

 private:
  struct State {
    double position = 0, speed = 0;
  };

  [[nodiscard]] double continuous_v(double time_s, const State& s) const {
    return p_.proportional_vpm * (reference_m(time_s) - s.position - p_.derivative_s * s.speed);
  }
  [[nodiscard]] double volts(double time_s, const State& s) const {
    return p_.held ? held_v_ : continuous_v(time_s, s);
  }
  [[nodiscard]] double acceleration(double time_s, const State& s) const {
    const FrictionCoefficients& f = p_.friction;
    const double friction_v = direction_ > 0 ? f.coulomb_positive_v + f.viscous_positive_vspm * s.speed
                                             : -f.coulomb_negative_v + f.viscous_negative_vspm * s.speed;
    return p_.gain * (volts(time_s, s) - friction_v);
  }

  [[nodiscard]] State moved(
      double h) const {  // Runge-Kutta step of order 4, friction of the present direction
    const auto at = [&](const State& rate, double part) {
      return State{state_.position + part * h * rate.position, state_.speed + part * h * rate.speed};
    };
    const auto rate = [&](const State& s, double part) {
      return State{s.speed, acceleration(time_s_ + part * h, s)};
    };
    const State k1 = rate(state_, 0), k2 = rate(at(k1, 0.5), 0.5), k3 = rate(at(k2, 0.5), 0.5),
                k4 = rate(at(k3, 1), 1);
    return {state_.position + h / 6 * (k1.position + 2 * k2.position + 2 * k3.position + k4.position),
            state_.speed + h / 6 * (k1.speed + 2 * k2.speed + 2 * k3.speed + k4.speed)};
  }

  /// Direction in which V exceeds the friction at rest; 0: V does not exceed it.
  [[nodiscard]] int pulled(double time_s) const {
    const double v = volts(time_s, state_);
    if (v > p_.friction.coulomb_positive_v) return 1;
    return v < -p_.friction.coulomb_negative_v ? -1 : 0;
  }

  /// Largest part of h for which `happens(part)` is false. @pre happens(h)
  template <class Event>
  static double before(double h, Event happens) {
    double low = 0, high = h;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      (happens(middle) ? high : low) = middle;
    }
    return high;
  }

  void advance(double h) {
    constexpr int kEvents = 8;  // stops and starts within one step
    for (int event = 0; event < kEvents && h > 0; ++event) {
      if (state_.speed == 0) direction_ = pulled(time_s_);
      const bool rests = direction_ == 0;
      const auto ends = [&](double part) {
        return rests ? pulled(time_s_ + part) != 0 : moved(part).speed * direction_ < 0;
      };
      const double part = ends(h) ? before(h, ends) : h;
      if (!rests) state_ = moved(part);
      time_s_ += part;
      if (part < h) state_.speed = 0;
      h -= part;
      if (rests && h > 0) direction_ = pulled(time_s_);
      if (rests && h > 0) state_ = {state_.position, direction_ * kStart_mps};
    }
  }

  static constexpr double kStart_mps = 1e-12;  // speed after a break-away; only the sign has an effect

  const TestProblem& p_;
  State state_;
  double time_s_ = 0, held_v_ = 0;
  int direction_ = 0;
};

}  // namespace

AxisRun simulate(const TestProblem& problem) { return Simulation{problem}.run(); }

}  // namespace crane::identification
