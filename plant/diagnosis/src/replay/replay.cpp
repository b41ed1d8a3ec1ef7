#include "crane/diagnosis/replay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "crane/diagnosis/course.hpp"
#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using plant::State;

/// A coordinate of a term's own may ring at 25 Hz.
constexpr double kLongestStep_s = 0.005, kLongestInnerStep_s = 0.0025;
constexpr double kSmoothing_s = 0.03;

bool has_sensor_term(const Crane& crane) {
  return std::any_of(crane.terms.begin(), crane.terms.end(), [](const plant::TermSetting& term) {
    const plant::TermKind* kind = plant::find_term(term.name);
    return kind != nullptr && kind->acts_on == plant::ActsOn::sensor;
  });
}

/// A drive's motion is not smoothed: that would take away from what excites the swing, a thousandth of the
/// amplitude already with second differences of neighbours.
Motion motion_of(Output output, const std::vector<double>& measured, double period_s) {
  const bool drive = output == kTrolleyPosition || output == kSlewAngle;
  return drive ? spline(measured, period_s) : smooth(measured, period_s, smoothing_half_width(period_s));
}

int steps_of(const Crane& crane, double period_s) {
  const bool inner = plant::Model(crane.parameters, crane.terms).inner_coordinates() > 0;
  return std::max(
      1, static_cast<int>(std::ceil(period_s / (inner ? kLongestInnerStep_s : kLongestStep_s) - 1e-9)));
}

/// Standard deviation of a value that is rounded to whole counts. What has no encoder is known to this.
std::array<double, kOutputs> noise_of_counts(const runtime::Rig& rig) {
  constexpr double kLeast = 1e-7;
  constexpr std::array<std::size_t, kOutputs> kEncoders{0, 1, 3, 4};
  std::array<double, kOutputs> noise{};
  for (std::size_t i = 0; i < kOutputs; ++i) {
    const double counts = rig.encoders[kEncoders[i]].counts_per_unit;
    noise[i] = counts > 0 ? std::max(kLeast, 1 / (counts * std::sqrt(12.0))) : kLeast;
  }
  return noise;
}

}  // namespace

const char* name_of(Part part) {
  return std::array{"whole", "drive", "load"}[static_cast<std::size_t>(part)];
}

int smoothing_half_width(double period_s) {
  return std::max(3, static_cast<int>(std::lround(kSmoothing_s / period_s)));
}

PreparedRun prepare(Run run, const runtime::Rig& rig) {
  PreparedRun prepared;
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (!run.measured[i].empty())
      prepared.motion[i] = motion_of(static_cast<Output>(i), run.measured[i], run.period_s);
  prepared.cable = smooth(run.cable_m, run.period_s, smoothing_half_width(run.period_s));
  prepared.kind = rig.kind;
  prepared.least_noise = noise_of_counts(rig);
  prepared.run = std::move(run);
  return prepared;
}

std::vector<Output> simulated_outputs(const PreparedRun& run, Part part) {
  std::vector<Output> outputs;
  for (const Output output : kAllOutputs) {
    const bool drive = output == kTrolleyPosition || output == kSlewAngle;
    if (run.run.has(output) && (part == Part::whole || (part == Part::drive) == drive))
      outputs.push_back(output);
  }
  return outputs;
}

struct Replay::Parts {
  Parts(const PreparedRun& prepared, const Crane& the_crane)
      : source(prepared),
        crane(the_crane),
        steps(steps_of(crane, prepared.run.period_s)),
        model(crane.parameters, crane.terms, step_s()),
        sensors(has_sensor_term(crane)) {
    ringing = model.ringing_coordinates();
    drive_v.reserve(prepared.run.rows() * static_cast<std::size_t>(steps));
    for (const plant::PerAxis& command : prepared.run.command_v)
      for (int step = 0; step < steps; ++step) drive_v.push_back(model.drive_voltage(command));
    if (sensors) undo_sensors();
    if (model.inner_coordinates() > 0) follow_inner();
  }

  /// Coordinates that stand still or go where they were measured while the others are simulated.
  [[nodiscard]] plant::Locks locks(const std::array<bool, kOutputs>& simulated) const {
    const bool loaded = crane.parameters.load_mass_kg > 0;
    plant::Locks locks;
    locks.axis = {!simulated[kTrolleyPosition], !simulated[kSlewAngle], true};
    locks.radial = !source.run.has(kRadialSwing) || !loaded;
    locks.tangential = !source.run.has(kTangentialSwing) || !loaded;
    return locks;
  }

  [[nodiscard]] double step_s() const { return source.run.period_s / steps; }
  /// Calls visit(voltage, whether it is another than before) for every step from a row to the next.
  template <class Visit>
  void visit_steps(std::size_t row, Visit&& visit) const {
    const auto first = row * static_cast<std::size_t>(steps);
    for (int step = 0; step < steps; ++step) {
      const auto at = first + static_cast<std::size_t>(step);
      visit(step, drive_v[at], step == 0 || drive_v[at] != drive_v[at - 1]);
    }
  }
  /// The course from a row to the next, what is not simulated as measured.
  template <class Given>
  void pass(Course& course, const Given& measured, std::size_t row) const {
    const double period_s = source.run.period_s;
    visit_steps(row, [&](int step, const plant::PerAxis& volts, bool changed) {
      const double middle = (step + 0.5) / steps;
      if (changed) course.new_command(volts);
      course.step(measured(row, middle), between(source.cable, row, middle, period_s));
    });
    course.follow(measured(row + 1, 0), between(source.cable, row + 1, 0, period_s));
  }

  [[nodiscard]] std::array<Moment, kOutputs> measured_at(const std::array<bool, kOutputs>& free,
                                                         std::size_t row, double share) const;
  void follow_inner();
  [[nodiscard]] const Motion& given(Output output) const {
    return sensors ? corrected[output] : source.motion[output];
  }

  /// What the coordinates were when the sensors reported what was measured: a drive's to a millionth of its
  /// encoder's scale, the swing's to first order, for to undo a delay again and again makes noise of it.
  void undo_sensors() {
    constexpr int kRounds = 5;
    const Run& run = source.run;
    std::array<std::vector<double>, kOutputs> values = run.measured;
    for (int round = 0; round < kRounds; ++round) {
      plant::Model fresh(crane.parameters, crane.terms, run.period_s);
      for (std::size_t k = 0; k < run.rows(); ++k) {
        State at;
        for (const Output output : kAllOutputs)
          if (run.has(output)) position_of(at, output) = values[output][k];
        at.cable_m = run.cable_m[k];
        const plant::Measurement reported = fresh.measure(at);
        for (const Output output : kAllOutputs)
          if (run.has(output) && (round == 0 || output == kTrolleyPosition || output == kSlewAngle))
            values[output][k] += run.measured[output][k] - measured_of(reported, output);
      }
    }
    for (const Output output : kAllOutputs)
      if (run.has(output)) corrected[output] = motion_of(output, values[output], run.period_s);
  }

  const PreparedRun& source;
  Crane crane;
  int steps;                   ///< from a row to the next
  mutable plant::Model model;  // friction and forces only; its memory is not used after construction
  bool sensors;
  std::vector<std::size_t> ringing;     ///< inner coordinates that have a start of their own
  std::vector<plant::PerAxis> drive_v;  ///< by step
  std::array<Motion, kOutputs> corrected;
  std::vector<plant::InnerState>
      inner_at;  ///< along the measured motion, by row; empty without inner coordinates
};

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
  Course course(model, none, locks(none), step_s());
  const auto measured = [&](std::size_t row, double share) { return measured_at(none, row, share); };
  course.follow(measured(0, 0), between(source.cable, 0, 0, period_s));
  for (std::size_t row = 0; row < source.run.rows(); ++row) {
    inner_at.push_back(course.inner);
    if (row + 1 == source.run.rows()) break;
    pass(course, measured, row);
  }
}

Replay::Replay(const PreparedRun& run, const Crane& crane) : parts_(std::make_unique<Parts>(run, crane)) {}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;

std::size_t Replay::start_size(Part part) const {
  return 2 * (simulated_outputs(parts_->source, part).size() + parts_->ringing.size());
}

std::vector<double> Replay::measured_start(Part part, std::size_t first) const {
  std::vector<double> start;
  for (const Output output : simulated_outputs(parts_->source, part)) {
    const Motion& motion = parts_->given(output);
    start.push_back(motion.position[first]);
    start.push_back(motion.rate[first]);
  }
  for (const std::size_t i : parts_->ringing) {
    start.push_back(parts_->inner_at[first][i].position);
    start.push_back(parts_->inner_at[first][i].rate);
  }
  return start;
}

void Replay::run(Part part, std::size_t first, std::size_t rows, std::span<const double> start,
                 std::span<double> out) const {
  const Parts& p = *parts_;
  const double period_s = p.source.run.period_s;
  const std::vector<Output> outputs = simulated_outputs(p.source, part);
  std::array<bool, kOutputs> simulated{};
  for (const Output output : outputs) simulated[output] = true;
  Course course(p.model, simulated, p.locks(simulated), p.step_s());
  const auto measured = [&](std::size_t row, double share) { return p.measured_at(simulated, row, share); };
  course.follow(measured(first, 0), between(p.source.cable, first, 0, period_s));
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    position_of(course.state, outputs[i]) = start[2 * i];
    rate_of(course.state, outputs[i]) = start[2 * i + 1];
  }
  if (!p.inner_at.empty()) course.inner = p.inner_at[first];
  for (std::size_t i = 0, at = 2 * outputs.size(); at < start.size(); ++i, at += 2)
    course.inner[p.ringing[i]] = {start[at], start[at + 1]};
  std::optional<plant::Model> sensing;
  if (p.sensors) sensing.emplace(p.crane.parameters, p.crane.terms, period_s);
  for (std::size_t k = 0; k < rows; ++k) {
    if (sensing) {
      const plant::Measurement reported = sensing->measure(course.state);
      for (std::size_t i = 0; i < outputs.size(); ++i) out[i * rows + k] = measured_of(reported, outputs[i]);
    } else {
      for (std::size_t i = 0; i < outputs.size(); ++i)
        out[i * rows + k] = position_of(course.state, outputs[i]);
    }
    if (k + 1 == rows) break;
    p.pass(course, measured, first + k);
  }
}

Replay::Guided Replay::guided(Output axis) const {
  const Parts& p = *parts_;
  const double period_s = p.source.run.period_s;
  const std::array<bool, kOutputs> none{};
  std::array<bool, kOutputs> drives{};
  for (const Output drive : simulated_outputs(p.source, Part::drive)) drives[drive] = true;
  Course course(p.model, none, p.locks(drives), period_s);
  const std::size_t rows = p.source.run.rows();
  const double h = p.step_s();
  Guided drive{p.given(axis).position, std::vector<double>(rows), std::vector<double>(rows)};
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    if (!p.inner_at.empty()) course.inner = p.inner_at[row];
    const auto middle = p.measured_at(none, row, 0.5);
    const Moment cable = between(p.source.cable, row, 0.5, period_s);
    double acceleration = 0;
    p.visit_steps(row, [&](int, const plant::PerAxis& volts, bool changed) {
      if (changed) {
        course.new_command(volts);
        acceleration = course.acceleration(axis, middle, cable);
      }
      drive.way[row] += h * (drive.speed[row] + 0.5 * h * acceleration);
      drive.speed[row] += h * acceleration;
    });
  }
  return drive;
}

Replays replays_of(const Runs& runs, const Crane& crane) {
  std::vector<std::optional<Replay>> made(runs.size());
  parallel_for(runs.size(), [&](std::size_t i) { made[i].emplace(runs[i], crane); });
  Replays replays;
  replays.reserve(made.size());
  for (auto& replay : made) replays.push_back(std::move(*replay));
  return replays;
}

}  // namespace crane::diagnosis
