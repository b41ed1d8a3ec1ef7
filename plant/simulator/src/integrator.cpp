#include "crane/simulator/integrator.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "motion_matrix.hpp"

namespace crane::simulator {
namespace {

using plant::Axis;
using plant::kAxes;
using plant::kStateSize;

using Coordinates = Eigen::Matrix<double, kCoordinates, 1>;

constexpr std::size_t kFunctions = 3 * kAxes;  // per axis: standstill, low, high

void must(int flag, const char* what) {
  if (flag >= 0) return;
  throw std::runtime_error(std::string{"CVODE "} + what + ": error " + std::to_string(flag));
}

plant::State state_of(N_Vector y) {
  plant::StateArray values{};
  std::copy_n(N_VGetArrayPointer(y), kStateSize, values.begin());
  return plant::to_state(values);
}

Coordinates to_vector(const plant::Accelerations& a) {
  return {a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
}

}  // namespace

bool Watch::active() const {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::find(standstill.begin(), standstill.end(), true) != standstill.end() ||
         std::any_of(low.begin(), low.end(), finite) || std::any_of(high.begin(), high.end(), finite);
}

struct Integrator::Solver {
  Solver(const plant::Model& crane, const Tolerances& tolerances) : model(crane) {
    must(SUNContext_Create(nullptr, &context), "context");
    y = N_VNew_Serial(kStateSize, context);
    matrix = new_motion_matrix(context);
    linear = new_motion_solver(context);
    cvode = CVodeCreate(CV_BDF, context);
    if (y == nullptr || matrix == nullptr || linear == nullptr || cvode == nullptr) {
      throw std::runtime_error("CVODE: out of memory");
    }
    N_VConst(0, y);
    must(CVodeInit(cvode, derivative, 0, y), "init");
    must(CVodeSetErrFile(cvode, nullptr), "error file");
    must(CVodeSStolerances(cvode, tolerances.relative, tolerances.absolute), "tolerances");
    must(CVodeSetUserData(cvode, this), "user data");
    must(CVodeSetLinearSolver(cvode, linear, matrix), "linear solver");
    must(CVodeSetJacFn(cvode, jacobian), "Jacobian");
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    if (cvode != nullptr) CVodeFree(&cvode);
    if (linear != nullptr) SUNLinSolFree(linear);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }

  [[nodiscard]] plant::Accelerations accelerations(const plant::State& state) {
    ++evaluations;
    return model.accelerations(state, *actuation);
  }

  static int derivative(realtype /*t*/, N_Vector y, N_Vector dydt, void* user) {
    const realtype* rates = N_VGetArrayPointer(y) + kCoordinates;
    realtype* out = std::copy_n(rates, kCoordinates, N_VGetArrayPointer(dydt));
    const Coordinates a = to_vector(static_cast<Solver*>(user)->accelerations(state_of(y)));
    std::copy_n(a.data(), kCoordinates, out);
    return 0;
  }

  /// Forward differences; the step is small against every smoothing speed of the terms.
  static int jacobian(realtype /*t*/, N_Vector y, N_Vector dydt, SUNMatrix matrix, void* user,
                      N_Vector /*w1*/, N_Vector /*w2*/, N_Vector /*w3*/) {
    constexpr double kStep = 1.5e-8;  // sqrt of the machine's relative accuracy
    auto& self = *static_cast<Solver*>(user);
    MotionMatrix& m = content_of(matrix);
    m.identity = 0;
    m.scale = 1;
    const Coordinates here = Eigen::Map<const Coordinates>{N_VGetArrayPointer(dydt) + kCoordinates};
    plant::StateArray at = plant::to_array(state_of(y));
    for (std::size_t i = 0; i < kStateSize; ++i) {
      const double kept = at[i];
      at[i] += kStep * std::max(1.0, std::abs(kept));
      const double step = at[i] - kept;
      const Coordinates slope = (to_vector(self.accelerations(plant::to_state(at))) - here) / step;
      const auto column = static_cast<Eigen::Index>(i);
      if (column < kCoordinates) {
        m.by_position.col(column) = slope;
      } else {
        m.by_rate.col(column - kCoordinates) = slope;
      }
      at[i] = kept;
    }
    return 0;
  }

  static int distances(realtype /*t*/, N_Vector y, realtype* distance, void* user) {
    const auto& self = *static_cast<const Solver*>(user);
    const realtype* at = N_VGetArrayPointer(y);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const std::size_t i = plant::kPositionIndex[axis];
      realtype* d = distance + 3 * axis;
      d[0] = self.watch->standstill[axis] ? at[i + plant::kSpeedOffset] : 1.0;
      d[1] = std::isfinite(self.watch->low[axis]) ? at[i] - self.watch->low[axis] : 1.0;
      d[2] = std::isfinite(self.watch->high[axis]) ? self.watch->high[axis] - at[i] : 1.0;
    }
    return 0;
  }

  [[nodiscard]] std::optional<Event> found() const {
    std::array<int, kFunctions> roots{};
    must(CVodeGetRootInfo(cvode, roots.data()), "root info");
    const auto first = std::find_if(roots.begin(), roots.end(), [](int root) { return root != 0; });
    if (first == roots.end()) return std::nullopt;
    const auto index = static_cast<std::size_t>(first - roots.begin());
    return Event{static_cast<EventKind>(index % 3), static_cast<Axis>(index / 3)};
  }

  const plant::Model& model;
  const plant::Actuation* actuation = nullptr;
  const Watch* watch = nullptr;
  long evaluations = 0;
  bool rooting = false;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* cvode = nullptr;
};

Integrator::Integrator(const plant::Model& model, const Tolerances& tolerances)
    : solver_(std::make_unique<Solver>(model, tolerances)) {}
Integrator::~Integrator() = default;

long Integrator::evaluations() const noexcept { return solver_->evaluations; }

Advance Integrator::advance(plant::State& state, const plant::Actuation& actuation, double span_s,
                            const Watch& watch) {
  Solver& s = *solver_;
  s.actuation = &actuation;
  s.watch = &watch;
  const plant::StateArray start = plant::to_array(state);
  std::copy(start.begin(), start.end(), N_VGetArrayPointer(s.y));
  must(CVodeReInit(s.cvode, 0, s.y), "restart");
  if (const bool wanted = watch.active(); wanted != s.rooting) {
    must(CVodeRootInit(s.cvode, wanted ? static_cast<int>(kFunctions) : 0,
                       wanted ? Solver::distances : nullptr),
         "root search");
    s.rooting = wanted;
  }
  realtype reached = 0;
  const int flag = CVode(s.cvode, span_s, s.y, &reached, CV_NORMAL);
  must(flag, "integration");
  state = state_of(s.y);
  if (flag == CV_ROOT_RETURN) return {.elapsed_s = reached, .event = s.found()};
  return {.elapsed_s = span_s, .event = std::nullopt};
}

}  // namespace crane::simulator
