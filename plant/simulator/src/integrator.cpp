#include "crane/simulator/integrator.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "motion_matrix.hpp"

namespace crane::simulator {
namespace {

using plant::Axis;
using plant::kAxes;

/// Accelerations of all coordinates: first those of the crane, then the inner coordinates.
using AllCoordinates = std::array<realtype, kCoordinates + plant::kMostInner>;
constexpr std::size_t kFunctions = 3 * kAxes;  // per axis: standstill, low, high

void must(int flag, const char* what) {
  if (flag >= 0) return;
  throw std::runtime_error(std::string{"CVODE "} + what + ": error " + std::to_string(flag));
}

/// State vector of CVODE: coordinates of the crane, inner coordinates, then the rates of all.
struct Motion {
  plant::State state;
  plant::InnerState inner{};
};

Motion motion_of(const realtype* y, std::size_t inner) {
  plant::StateArray values{};
  const realtype* rates = y + kCoordinates + inner;
  std::copy_n(y, kCoordinates, values.begin());
  std::copy_n(rates, kCoordinates, values.begin() + kCoordinates);
  Motion motion{.state = plant::to_state(values)};
  for (std::size_t i = 0; i < inner; ++i)
    motion.inner[i] = {.position = y[kCoordinates + i], .rate = rates[kCoordinates + i]};
  return motion;
}

void store(const Motion& motion, std::size_t inner, realtype* y) {
  const plant::StateArray values = plant::to_array(motion.state);
  realtype* rates = y + kCoordinates + inner;
  std::copy_n(values.begin(), kCoordinates, y);
  std::copy_n(values.begin() + kCoordinates, kCoordinates, rates);
  for (std::size_t i = 0; i < inner; ++i) {
    y[kCoordinates + i] = motion.inner[i].position;
    rates[kCoordinates + i] = motion.inner[i].rate;
  }
}

}  // namespace

bool Watch::active() const {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::find(standstill.begin(), standstill.end(), true) != standstill.end() ||
         std::any_of(low.begin(), low.end(), finite) || std::any_of(high.begin(), high.end(), finite);
}

struct Integrator::Solver {
  Solver(const plant::Model& crane, const Tolerances& tolerances)
      : model(crane), inner(crane.inner_coordinates()), half(kCoordinates + inner) {
    must(SUNContext_Create(nullptr, &context), "context");
    y = N_VNew_Serial(static_cast<sunindextype>(2 * half), context);
    matrix = inner == 0 ? new_motion_matrix(context) : new_dense_matrix();
    linear = inner == 0 ? new_motion_solver(context) : SUNLinSol_Dense(y, matrix, context);
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

  [[nodiscard]] SUNMatrix new_dense_matrix() const {
    const auto size = static_cast<sunindextype>(2 * half);
    return SUNDenseMatrix(size, size, context);
  }

  [[nodiscard]] AllCoordinates accelerations(const realtype* at) {
    ++evaluations;
    const Motion motion = motion_of(at, inner);
    plant::InnerAccelerations own{};
    const plant::Accelerations a = model.accelerations(motion.state, *actuation, motion.inner, own);
    AllCoordinates all{a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
    std::copy_n(own.begin(), inner, all.begin() + kCoordinates);
    return all;
  }

  static int derivative(realtype /*t*/, N_Vector y, N_Vector dydt, void* user) {
    auto& self = *static_cast<Solver*>(user);
    const realtype* at = N_VGetArrayPointer(y);
    realtype* out = std::copy_n(at + self.half, self.half, N_VGetArrayPointer(dydt));
    std::copy_n(self.accelerations(at).begin(), self.half, out);
    return 0;
  }

  /// Jacobian by forward differences. The step is small compared with every smoothing speed of the terms.
  static int jacobian(realtype /*t*/, N_Vector y, N_Vector dydt, SUNMatrix matrix, void* user,
                      N_Vector /*w1*/, N_Vector /*w2*/, N_Vector /*w3*/) {
    constexpr double kStep = 1.5e-8;  // square root of the machine epsilon
    auto& self = *static_cast<Solver*>(user);
    const realtype* here = N_VGetArrayPointer(dydt) + self.half;
    std::array<realtype, 2 * std::tuple_size_v<AllCoordinates>> at{};
    std::copy_n(N_VGetArrayPointer(y), 2 * self.half, at.begin());
    for (std::size_t i = 0; i < 2 * self.half; ++i) {
      const double kept = at[i];
      at[i] += kStep * std::max(1.0, std::abs(kept));
      const double step = at[i] - kept;
      AllCoordinates slope = self.accelerations(at.data());
      for (std::size_t j = 0; j < self.half; ++j) slope[j] = (slope[j] - here[j]) / step;
      self.store_column(matrix, i, slope);
      at[i] = kept;
    }
    return 0;
  }

  /// Column `i` of [A B] in J = [0 I; A B].
  void store_column(SUNMatrix into, std::size_t i, const AllCoordinates& slope) const {
    if (inner > 0) {
      realtype* column = SUNDenseMatrix_Column(into, static_cast<sunindextype>(i));
      std::copy_n(slope.begin(), half, column + half);
      if (i >= half) column[i - half] = 1;
      return;
    }
    MotionMatrix& m = content_of(into);
    m.identity = 0;
    m.scale = 1;
    const auto index = static_cast<Eigen::Index>(i);
    auto& block = index < kCoordinates ? m.by_position : m.by_rate;
    block.col(index % kCoordinates) = Eigen::Map<const Eigen::Matrix<double, kCoordinates, 1>>{slope.data()};
  }

  static int distances(realtype /*t*/, N_Vector y, realtype* distance, void* user) {
    const auto& self = *static_cast<const Solver*>(user);
    const realtype* at = N_VGetArrayPointer(y);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const std::size_t i = plant::kPositionIndex[axis];
      realtype* d = distance + 3 * axis;
      d[0] = self.watch->standstill[axis] ? at[i + self.half] : 1.0;
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
  const std::size_t inner, half;  ///< number of inner coordinates; number of all coordinates
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
  plant::InnerState inner{};
  return advance(state, inner, actuation, span_s, watch);
}

Advance Integrator::advance(plant::State& state, plant::InnerState& inner, const plant::Actuation& actuation,
                            double span_s, const Watch& watch) {
  Solver& s = *solver_;
  s.actuation = &actuation;
  s.watch = &watch;
  store({state, inner}, s.inner, N_VGetArrayPointer(s.y));
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
  const Motion reached_motion = motion_of(N_VGetArrayPointer(s.y), s.inner);
  state = reached_motion.state;
  inner = reached_motion.inner;
  if (flag == CV_ROOT_RETURN) return {.elapsed_s = reached, .event = s.found()};
  return {.elapsed_s = span_s, .event = std::nullopt};
}

}  // namespace crane::simulator
