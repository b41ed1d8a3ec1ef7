#include "replay/sensitivity_reference.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace crane::diagnosis {
namespace {

using plant::kSlew;
using plant::kTrolley;

constexpr double kRelative = 1e-9, kAbsolute = 1e-10;
/// Central difference of df/dy s + df/dp, as a share of the parameter's step.
constexpr double kShare = 1e-3;
/// State of the crane, then the voltages of trolley and slew after the first pole and after the second pole.
constexpr std::size_t kFirst = plant::kStateSize, kSecond = kFirst + 2, kSize = kSecond + 2;
using Values = std::array<double, kSize>;

/// Command terms of an axis.
struct Input {
  double factor = 1, offset_v = 0, lag_s = 0, second_lag_s = 0, delay_s = 0;
};

struct SmoothCrane {
  explicit SmoothCrane(const Crane& crane) : model(crane.parameters, other_terms(crane)) {
    for (const plant::TermSetting& term : crane.terms) {
      if (plant::find_term(term.name)->acts_on != plant::ActsOn::command) continue;
      Input& in = input[term.axis == "slew" ? kSlew : kTrolley];
      if (term.name == "motor_gain") in.factor *= term.parameters.at("factor");
      if (term.name == "command_offset") in.offset_v += term.parameters.at("offset_v");
      if (term.name == "actuator_lag") {
        in.lag_s = term.parameters.at("time_constant_s");
        in.second_lag_s = term.parameters.at("second_s");
      }
      if (term.name == "command_delay") in.delay_s = term.parameters.at("delay_s");
    }
  }

  static std::vector<plant::TermSetting> other_terms(const Crane& crane) {
    std::vector<plant::TermSetting> terms;
    for (const plant::TermSetting& term : crane.terms)
      if (plant::find_term(term.name)->acts_on != plant::ActsOn::command) terms.push_back(term);
    return terms;
  }

  /// @param locks prescribed drives, or the hoist only
  [[nodiscard]] Values derivative(const Values& y, const plant::PerAxis& command_v,
                                  const plant::Locks& locks) const {
    plant::StateArray at{};
    std::copy_n(y.begin(), plant::kStateSize, at.begin());
    plant::Actuation actuation;
    actuation.locks = locks;
    Values slope{};
    for (const std::size_t axis : {kTrolley, kSlew}) {
      const Input& in = input[axis];
      const double wanted_v = in.factor * command_v[axis] + in.offset_v;
      const double once_v = in.lag_s > 0 ? y[kFirst + axis] : wanted_v;
      actuation.drive_v[axis] = in.second_lag_s > 0 ? y[kSecond + axis] : once_v;
      if (in.lag_s > 0) slope[kFirst + axis] = (wanted_v - once_v) / in.lag_s;
      if (in.second_lag_s > 0) slope[kSecond + axis] = (once_v - y[kSecond + axis]) / in.second_lag_s;
    }
    const plant::Accelerations a = model.accelerations(plant::to_state(at), actuation);
    std::copy_n(y.begin() + plant::kSpeedOffset, plant::kSpeedOffset, slope.begin());
    const std::array accelerations{a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, 0.0};
    std::copy(accelerations.begin(), accelerations.end(), slope.begin() + plant::kSpeedOffset);
    return slope;
  }

  [[nodiscard]] Reported reported(const Values& y) {
    plant::StateArray at{};
    std::copy_n(y.begin(), plant::kStateSize, at.begin());
    const plant::Measurement m = model.measure(plant::to_state(at));
    return {m.trolley_m, m.slew_rad, m.radial_rad, m.tangential_rad};
  }

  plant::Model model;
  std::array<Input, 2> input;
};

Values moved(const Values& y, double by, const Values& along) {
  Values sum = y;
  for (std::size_t i = 0; i < kSize; ++i) sum[i] += by * along[i];
  return sum;
}

template <class Numbers>
Numbers difference(const Numbers& more, const Numbers& less, double over) {
  Numbers result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (more[i] - less[i]) / over;
  return result;
}

void must(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string{"CVODES "} + what + ": error " + std::to_string(flag));
}

class Solver {
 public:
  Solver(const Varied& varied, Part part)
      : here_(varied.crane(varied.value)),
        more_(varied.crane(varied.value + kShare * varied.step)),
        less_(varied.crane(varied.value - kShare * varied.step)),
        change_(kShare * varied.step),
        part_(part) {
    free_.axis[plant::kHoist] = true;
    must(SUNContext_Create(nullptr, &context_), "context");
    y_ = N_VNew_Serial(kSize, context_);
    s_ = N_VNew_Serial(kSize, context_);
    matrix_ = SUNDenseMatrix(kSize, kSize, context_);
    linear_ = SUNLinSol_Dense(y_, matrix_, context_);
    cvodes_ = CVodeCreate(CV_BDF, context_);
    N_VConst(0, y_);
    N_VConst(0, s_);
    must(CVodeInit(cvodes_, motion, 0, y_), "init");
    must(CVodeSStolerances(cvodes_, kRelative, kAbsolute), "tolerances");
    must(CVodeSetUserData(cvodes_, this), "user data");
    must(CVodeSetLinearSolver(cvodes_, linear_, matrix_), "linear solver");
    must(CVodeSetMaxNumSteps(cvodes_, 20'000), "steps");
    must(CVodeSensInit1(cvodes_, 1, CV_SIMULTANEOUS, sensitivities, &s_), "sensitivities");
    double absolute = kAbsolute / varied.step;
    must(CVodeSensSStolerances(cvodes_, kRelative, &absolute), "tolerances of sensitivities");
    must(CVodeSetSensErrCon(cvodes_, SUNTRUE), "error control");
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    CVodeFree(&cvodes_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
    N_VDestroy(s_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  Values y{}, s{};

  [[nodiscard]] double delay_s(std::size_t axis) const { return here_.input[axis].delay_s; }

  /// Integrates until the next edge of the command.
  void advance(double from_s, double until_s, const plant::PerAxis& command_v) {
    command_v_ = command_v;
    std::copy(y.begin(), y.end(), N_VGetArrayPointer(y_));
    std::copy(s.begin(), s.end(), N_VGetArrayPointer(s_));
    must(CVodeReInit(cvodes_, from_s, y_), "restart");
    must(CVodeSensReInit(cvodes_, CV_SIMULTANEOUS, &s_), "restart of sensitivities");
    must(CVodeSetStopTime(cvodes_, until_s), "stop time");
    double reached_s = 0;
    must(CVode(cvodes_, until_s, y_, &reached_s, CV_NORMAL), "integration");
    must(CVodeGetSens(cvodes_, &reached_s, &s_), "result");
    std::copy_n(N_VGetArrayPointer(y_), kSize, y.begin());
    std::copy_n(N_VGetArrayPointer(s_), kSize, s.begin());
  }

  /// A delay shifts the edge: s += (f before - f after) dt/dp.
  void cross_edge(const plant::PerAxis& before_v, const plant::PerAxis& after_v, std::size_t axis) {
    const double later = (more_.input[axis].delay_s - less_.input[axis].delay_s) / (2 * change_);
    if (later == 0) return;
    Values jump = difference(here_.derivative(y, before_v, free_), here_.derivative(y, after_v, free_), 1);
    keep_free(jump);
    s = moved(s, later, jump);
  }

  [[nodiscard]] Reported reported() { return here_.reported(y); }
  [[nodiscard]] Reported reported_slope() {
    return difference(more_.reported(moved(y, change_, s)), less_.reported(moved(y, -change_, s)),
                      2 * change_);
  }

 private:
  static int motion(realtype /*t*/, N_Vector y, N_Vector dydt, void* user) {
    const auto& self = *static_cast<Solver*>(user);
    store(self.here_.derivative(load(y), self.command_v_, self.free_), dydt);
    return 0;
  }

  static int sensitivities(int /*count*/, realtype /*t*/, N_Vector y, N_Vector dydt, int /*which*/,
                           N_Vector s, N_Vector dsdt, void* user, N_Vector /*w1*/, N_Vector /*w2*/) {
    const auto& self = *static_cast<Solver*>(user);
    const Values at = load(y), slope = load(dydt), along = load(s);
    plant::Locks locks = self.free_;
    if (self.part_ == Part::load) {
      locks.axis = {true, true, true};
      locks.acceleration = {slope[plant::kSpeedOffset], slope[plant::kSpeedOffset + 2], 0};
    }
    Values change = difference(self.more_.derivative(moved(at, self.change_, along), self.command_v_, locks),
                               self.less_.derivative(moved(at, -self.change_, along), self.command_v_, locks),
                               2 * self.change_);
    self.keep_free(change);
    store(change, dsdt);
    return 0;
  }

  /// The sensitivity of a prescribed coordinate is 0.
  void keep_free(Values& slope) const {
    for (const std::size_t i : {0U, 1U, 2U, 3U}) {
      const bool drive = i % 2 == 0;  // trolley, radial, slew, tangential
      if (part_ != Part::whole && (part_ == Part::drive) != drive)
        slope[i] = slope[i + plant::kSpeedOffset] = 0;
    }
  }

  static Values load(N_Vector from) {
    Values values{};
    std::copy_n(N_VGetArrayPointer(from), kSize, values.begin());
    return values;
  }
  static void store(const Values& values, N_Vector into) {
    std::copy(values.begin(), values.end(), N_VGetArrayPointer(into));
  }

  SmoothCrane here_, more_, less_;
  double change_;
  Part part_;
  plant::Locks free_;
  plant::PerAxis command_v_{};
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, s_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  void* cvodes_ = nullptr;
};

struct Edge {
  double at_s = 0;
  std::size_t axis = 0, row = 0;
};

/// Times of the edges of the voltages, in order.
std::vector<Edge> edges_of(const Solver& solver, std::size_t rows, double period_s) {
  std::vector<Edge> edges;
  for (const std::size_t axis : {kTrolley, kSlew})
    for (std::size_t k = 0; k < rows; ++k)
      edges.push_back({static_cast<double>(k) * period_s + solver.delay_s(axis), axis, k});
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at_s < b.at_s; });
  return edges;
}

}  // namespace

Sensitivity sensitivity(const Varied& varied, Part part, const std::vector<plant::PerAxis>& command_v,
                        double period_s, const plant::State& start) {
  constexpr double kSame_s = 1e-9;
  Solver solver(varied, part);
  const plant::StateArray begin = plant::to_array(start);
  std::copy(begin.begin(), begin.end(), solver.y.begin());
  const std::vector<Edge> edges = edges_of(solver, command_v.size(), period_s);
  Sensitivity result;
  plant::PerAxis now_v{};
  double now_s = 0;
  std::size_t next = 0;
  for (std::size_t k = 0; k < command_v.size(); ++k) {
    const double tick_s = static_cast<double>(k) * period_s;
    const auto pass_edges = [&](double until_s) {
      for (; next < edges.size() && edges[next].at_s < until_s; ++next) {
        if (edges[next].at_s > now_s + kSame_s) solver.advance(now_s, edges[next].at_s, now_v);
        now_s = std::max(now_s, edges[next].at_s);
        const plant::PerAxis before_v = now_v;
        now_v[edges[next].axis] = command_v[edges[next].row][edges[next].axis];
        solver.cross_edge(before_v, now_v, edges[next].axis);
      }
    };
    pass_edges(tick_s - kSame_s);
    if (tick_s > now_s + kSame_s) solver.advance(now_s, tick_s, now_v);
    now_s = tick_s;
    result.reported.push_back(solver.reported());
    result.slope.push_back(solver.reported_slope());
    plant::StateArray at{};
    std::copy_n(solver.y.begin(), plant::kStateSize, at.begin());
    result.state.push_back(plant::to_state(at));
    pass_edges(tick_s + kSame_s);
  }
  return result;
}

}  // namespace crane::diagnosis
