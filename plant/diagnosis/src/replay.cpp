#include "crane/diagnosis/replay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "friction_step.hpp"

namespace crane::diagnosis {
namespace {

using plant::kAxes;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;
using plant::State;

/// A coordinate of a term's own may ring at 15 Hz.
constexpr double kLongestStep_s = 0.005, kLongestInnerStep_s = 0.0025;
constexpr double kSmoothing_s = 0.03;

/// Position, rate and acceleration of a measured coordinate between two samples.
struct Moment {
  double position = 0, rate = 0, acceleration = 0;
};

Moment between(const Motion& motion, std::size_t row, double share, double period_s) {
  if (motion.position.empty()) return {};
  const std::size_t next = std::min(row + 1, motion.position.size() - 1);
  const double p0 = motion.position[row], p1 = motion.position[next];
  const double r0 = motion.rate[row], r1 = motion.rate[next];
  const double s = share, s2 = s * s, s3 = s2 * s;
  return {.position = (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * period_s * r0 +
                      (3 * s2 - 2 * s3) * p1 + (s3 - s2) * period_s * r1,
          .rate = (1 - s) * r0 + s * r1,
          .acceleration = (1 - s) * motion.acceleration[row] + s * motion.acceleration[next]};
}

double& position_of(State& s, Output output) {
  switch (output) {
    case kTrolleyPosition:
      return s.trolley_m;
    case kSlewAngle:
      return s.slew_rad;
    case kRadialSwing:
      return s.radial_rad;
    default:
      return s.tangential_rad;
  }
}

double& rate_of(State& s, Output output) {
  switch (output) {
    case kTrolleyPosition:
      return s.trolley_mps;
    case kSlewAngle:
      return s.slew_radps;
    case kRadialSwing:
      return s.radial_radps;
    default:
      return s.tangential_radps;
  }
}

double acceleration_of(const plant::Accelerations& a, Output output) {
  return std::array{a.trolley_mps2, a.slew_radps2, a.radial_radps2, a.tangential_radps2}[output];
}

double measured_of(const plant::Measurement& m, Output output) {
  return std::array{m.trolley_m, m.slew_rad, m.radial_rad, m.tangential_rad}[output];
}

bool has_sensor_term(const Crane& crane) {
  return std::any_of(crane.terms.begin(), crane.terms.end(), [](const plant::TermSetting& term) {
    const plant::TermKind* kind = plant::find_term(term.name);
    return kind != nullptr && kind->acts_on == plant::ActsOn::sensor;
  });
}

}  // namespace

const char* name_of(Part part) {
  return std::array{"whole", "drive", "load"}[static_cast<std::size_t>(part)];
}

namespace {

/// A drive's acceleration is not smoothed: it is integrated twice again, which gives back the measured
/// position, and smoothing would take away from what excites the swing.
int half_width_of(Output output, double period_s) {
  return output == kTrolleyPosition || output == kSlewAngle ? 1 : smoothing_half_width(period_s);
}

}  // namespace

int smoothing_half_width(double period_s) {
  return std::max(3, static_cast<int>(std::lround(kSmoothing_s / period_s)));
}

PreparedRun prepare(Run run, const runtime::Rig& rig) {
  PreparedRun prepared;
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (!run.measured[i].empty())
      prepared.motion[i] =
          smooth(run.measured[i], run.period_s, half_width_of(static_cast<Output>(i), run.period_s));
  prepared.cable = smooth(run.cable_m, run.period_s, smoothing_half_width(run.period_s));
  prepared.kind = rig.kind;
  prepared.run = std::move(run);
  return prepared;
}

std::vector<Output> simulated_outputs(const PreparedRun& run, Part part) {
  std::vector<Output> outputs;
  for (const Output output : {kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing}) {
    const bool drive = output == kTrolleyPosition || output == kSlewAngle;
    if (run.run.has(output) && (part == Part::whole || (part == Part::drive) == drive))
      outputs.push_back(output);
  }
  return outputs;
}

struct Replay::Parts {
  Parts(const PreparedRun& prepared, const Crane& the_crane, Part part)
      : source(prepared),
        crane(the_crane),
        model(crane.parameters, crane.terms, prepared.run.period_s),
        sensors(has_sensor_term(crane)),
        outputs(simulated_outputs(prepared, part)) {
    for (const Output output : outputs) simulated[output] = true;
    const double longest_s = model.inner_coordinates() > 0 ? kLongestInnerStep_s : kLongestStep_s;
    steps = std::max(1, static_cast<int>(std::ceil(prepared.run.period_s / longest_s - 1e-9)));
    for (const plant::PerAxis& command : prepared.run.command_v)
      drive_v.push_back(model.drive_voltage(command));
    if (sensors) undo_sensors();
    still.axis = {!prepared.run.has(kTrolleyPosition), !prepared.run.has(kSlewAngle), true};
    still.radial = !prepared.run.has(kRadialSwing) || crane.parameters.load_mass_kg == 0;
    still.tangential = !prepared.run.has(kTangentialSwing) || crane.parameters.load_mass_kg == 0;
    for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
      driven[axis] = simulated[axis];
      if (!simulated[axis]) still.axis[axis] = true;
    }
  }

  [[nodiscard]] std::array<Moment, kOutputs> measured_at(const std::array<bool, kOutputs>& free,
                                                         std::size_t row, double share) const;
  void follow_inner();
  [[nodiscard]] const Motion& given(Output output) const {
    return sensors ? corrected[output] : source.motion[output];
  }

  /// What the coordinates were when the sensors reported what was measured, to first order in the sensors'
  /// errors.
  void undo_sensors() {
    const Run& run = source.run;
    plant::Model fresh(crane.parameters, crane.terms, run.period_s);
    std::array<std::vector<double>, kOutputs> values = run.measured;
    for (std::size_t k = 0; k < run.rows(); ++k) {
      State at;
      for (std::size_t i = 0; i < kOutputs; ++i)
        if (!values[i].empty()) position_of(at, static_cast<Output>(i)) = run.measured[i][k];
      at.cable_m = run.cable_m[k];
      const plant::Measurement reported = fresh.measure(at);
      for (std::size_t i = 0; i < kOutputs; ++i)
        if (!values[i].empty())
          values[i][k] += run.measured[i][k] - measured_of(reported, static_cast<Output>(i));
    }
    for (std::size_t i = 0; i < kOutputs; ++i)
      if (!values[i].empty())
        corrected[i] = smooth(values[i], run.period_s, half_width_of(static_cast<Output>(i), run.period_s));
  }

  const PreparedRun& source;
  Crane crane;
  mutable plant::Model model;  // friction and forces only; its memory is not used after construction
  bool sensors;
  std::vector<Output> outputs;
  std::array<bool, kOutputs> simulated{};
  std::array<bool, 2> driven{};
  int steps = 1;
  plant::Locks still;
  std::vector<plant::PerAxis> drive_v;
  std::array<Motion, kOutputs> corrected;
  std::vector<plant::InnerState>
      inner_at;  ///< along the measured motion, by row; empty without inner coordinates
};

namespace {

/// One window under way.
class Course {
 public:
  Course(const plant::Model& model, const std::array<bool, kOutputs>& simulated, const plant::Locks& locks,
         double step_s)
      : model_(model), simulated_(simulated), h_(step_s) {
    actuation_.locks = locks;
  }

  State state;
  plant::InnerState inner{};
  plant::PerAxis volt{};

  void new_command(const plant::PerAxis& drive_v) {
    actuation_.drive_v = drive_v;
    gains_known_ = false;
  }

  /// @param at what is measured in the middle of the step, `end` at its end
  void step(const std::array<Moment, kOutputs>& at, const Moment& cable_at,
            const std::array<Moment, kOutputs>& end, const Moment& cable_end) {
    const State middle = half_way(at, cable_at);
    plant::InnerState inner_middle = inner;
    for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
      inner_middle[i].position += 0.5 * h_ * inner[i].rate;
      inner_middle[i].rate += 0.5 * h_ * last_inner_[i];
    }
    plant::PerAxis friction{};
    if (simulated_[kTrolleyPosition] || simulated_[kSlewAngle]) friction = move_drives(middle, inner_middle);
    const bool needed =
        simulated_[kRadialSwing] || simulated_[kTangentialSwing] || model_.inner_coordinates() > 0;
    if (needed) {
      plant::InnerAccelerations inner_acceleration{};
      const plant::Accelerations a =
          model_.accelerations(middle, actuation_, friction, inner_middle, inner_acceleration);
      for (const Output swing : {kRadialSwing, kTangentialSwing})
        if (simulated_[swing]) kick(swing, acceleration_of(a, swing));
      for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
        const double before = inner[i].rate;
        inner[i].rate += h_ * inner_acceleration[i];
        inner[i].position += 0.5 * h_ * (before + inner[i].rate);
        last_inner_[i] = inner_acceleration[i];
      }
    }
    follow(end, cable_end);
  }

  /// Coordinates that are not simulated go where they were measured.
  void follow(const std::array<Moment, kOutputs>& at, const Moment& cable) {
    for (const Output output : {kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing}) {
      if (simulated_[output]) continue;
      position_of(state, output) = at[output].position;
      rate_of(state, output) = at[output].rate;
    }
    state.cable_m = cable.position;
    state.cable_mps = cable.rate;
  }

 private:
  State half_way(const std::array<Moment, kOutputs>& at, const Moment& cable) {
    State middle = state;
    for (const Output output : {kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing}) {
      if (simulated_[output]) {
        position_of(middle, output) += 0.5 * h_ * rate_of(state, output);
        rate_of(middle, output) += 0.5 * h_ * last_[output];
      } else {
        position_of(middle, output) = at[output].position;
        rate_of(middle, output) = at[output].rate;
      }
    }
    middle.cable_m = cable.position;
    middle.cable_mps = cable.rate;
    actuation_.locks.acceleration = {at[kTrolleyPosition].acceleration, at[kSlewAngle].acceleration,
                                     cable.acceleration};
    return middle;
  }

  void kick(Output output, double acceleration) {
    double& rate = rate_of(state, output);
    const double before = rate;
    rate += h_ * acceleration;
    position_of(state, output) += 0.5 * h_ * (before + rate);
    last_[output] = acceleration;
  }

  plant::PerAxis drive_accelerations(const State& middle, const plant::InnerState& inner_middle,
                                     const plant::PerAxis& friction) const {
    plant::InnerAccelerations ignored{};
    const plant::Accelerations a = model_.accelerations(middle, actuation_, friction, inner_middle, ignored);
    return {a.trolley_mps2, a.slew_radps2, 0};
  }

  /// Friction of each axis, solved one after the other with the other's last value.
  plant::PerAxis move_drives(const State& middle, const plant::InnerState& inner_middle) {
    const plant::PerAxis free = drive_accelerations(middle, inner_middle, {});
    if (!gains_known_) {
      for (const std::size_t axis : {kTrolley, kSlew}) {
        plant::PerAxis one{};
        one[axis] = 1;
        const plant::PerAxis taken = drive_accelerations(middle, inner_middle, one);
        for (const std::size_t other : {kTrolley, kSlew}) gain_[other][axis] = free[other] - taken[other];
      }
      gains_known_ = true;
    }
    plant::PerAxis friction = last_friction_;
    for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
      if (!simulated_[axis]) continue;
      const std::size_t other = 1 - axis;
      const double pull = free[axis] - (simulated_[other] ? gain_[axis][other] * friction[other] : 0);
      State moving = middle;
      const auto friction_at = [&](double speed) {
        rate_of(moving, axis) = speed;
        return model_.friction_v(moving)[axis];
      };
      const FrictionStep done = friction_step(rate_of(state, axis), pull, gain_[axis][axis], h_, friction_at);
      friction[axis] = done.friction;
      last_[axis] = (done.speed - rate_of(state, axis)) / h_;
      rate_of(state, axis) = done.speed;
      position_of(state, axis) += done.way;
    }
    last_friction_ = friction;
    return friction;
  }

  const plant::Model& model_;
  std::array<bool, kOutputs> simulated_;
  double h_;
  plant::Actuation actuation_;
  std::array<double, kOutputs> last_{};
  std::array<double, plant::kMostInner> last_inner_{};
  plant::PerAxis last_friction_{};
  std::array<std::array<double, 2>, 2> gain_{};
  bool gains_known_ = false;
};

}  // namespace

namespace {

/// Runs `window` over one period from `row`, measured motion between.
template <class Given>
void pass(Course& course, const Given& given, const Motion& cable, std::size_t row, int steps,
          double period_s) {
  for (int step = 0; step < steps; ++step) {
    const double middle = (step + 0.5) / steps, end = (step + 1.0) / steps;
    course.step(given(row, middle), between(cable, row, middle, period_s), given(row, end),
                between(cable, row, end, period_s));
  }
}

}  // namespace

std::array<Moment, kOutputs> Replay::Parts::measured_at(const std::array<bool, kOutputs>& free,
                                                        std::size_t row, double share) const {
  std::array<Moment, kOutputs> at;
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (!free[i]) at[i] = between(given(static_cast<Output>(i)), row, share, source.run.period_s);
  return at;
}

/// The terms' own coordinates are not measured, but what drives them is: they follow it through the whole
/// run.
void Replay::Parts::follow_inner() {
  const double period_s = source.run.period_s;
  const std::array<bool, kOutputs> none{};
  plant::Locks all = still;
  all.axis = {true, true, true};
  Course course(model, none, all, period_s / steps);
  const auto measured = [&](std::size_t row, double share) { return measured_at(none, row, share); };
  course.follow(measured(0, 0), between(source.cable, 0, 0, period_s));
  for (std::size_t row = 0; row < source.run.rows(); ++row) {
    inner_at.push_back(course.inner);
    if (row + 1 == source.run.rows()) break;
    course.new_command(drive_v[row]);
    pass(course, measured, source.cable, row, steps, period_s);
  }
}

Replay::Replay(const PreparedRun& run, const Crane& crane, Part part)
    : parts_(std::make_unique<Parts>(run, crane, part)) {
  if (parts_->model.inner_coordinates() > 0) parts_->follow_inner();
}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;

std::size_t Replay::start_size() const { return 2 * parts_->outputs.size(); }

std::vector<double> Replay::measured_start(std::size_t first) const {
  std::vector<double> start;
  for (const Output output : parts_->outputs) {
    const Motion& motion = parts_->given(output);
    start.push_back(motion.position[first]);
    start.push_back(motion.rate[first]);
  }
  return start;
}

void Replay::run(std::size_t first, std::size_t rows, std::span<const double> start,
                 std::span<double> out) const {
  const Parts& p = *parts_;
  const double period_s = p.source.run.period_s;
  Course course(p.model, p.simulated, p.still, period_s / p.steps);
  const auto measured = [&](std::size_t row, double share) { return p.measured_at(p.simulated, row, share); };
  course.follow(measured(first, 0), between(p.source.cable, first, 0, period_s));
  for (std::size_t i = 0; i < p.outputs.size(); ++i) {
    position_of(course.state, p.outputs[i]) = start[2 * i];
    rate_of(course.state, p.outputs[i]) = start[2 * i + 1];
  }
  if (!p.inner_at.empty()) course.inner = p.inner_at[first];
  std::optional<plant::Model> sensing;
  if (p.sensors) sensing.emplace(p.crane.parameters, p.crane.terms, period_s);
  for (std::size_t k = 0; k < rows; ++k) {
    if (sensing) {
      const plant::Measurement reported = sensing->measure(course.state);
      for (std::size_t i = 0; i < p.outputs.size(); ++i)
        out[i * rows + k] = measured_of(reported, p.outputs[i]);
    } else {
      for (std::size_t i = 0; i < p.outputs.size(); ++i)
        out[i * rows + k] = position_of(course.state, p.outputs[i]);
    }
    if (k + 1 == rows) break;
    course.new_command(p.drive_v[first + k]);
    pass(course, measured, p.source.cable, first + k, p.steps, period_s);
  }
}

}  // namespace crane::diagnosis
