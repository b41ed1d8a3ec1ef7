#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "motion_matrix.hpp"
#include "solver.hpp"

namespace crane::simulator {
namespace {

static_assert(kCoordinates == kRigid);

/// Accelerations of all coordinates: first those of the crane, then the inner coordinates.
using AllCoordinates = std::array<realtype, kCoordinates + plant::kMostInner>;

void must(int flag, const char* what) {
  if (flag >= 0) return;
  throw std::runtime_error(std::string{"CVODE "} + what + ": error " + std::to_string(flag));
}

class CvodeSolver final : public Solver {
 public:
  CvodeSolver(const plant::Model& crane, const Tolerances& tolerances)
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
  CvodeSolver(const CvodeSolver&) = delete;
  CvodeSolver& operator=(const CvodeSolver&) = delete;
  ~CvodeSolver() override {
    if (cvode != nullptr) CVodeFree(&cvode);
    if (linear != nullptr) SUNLinSolFree(linear);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }

  Advance advance(Motion& motion, const plant::Actuation& inputs, double span_s, const Watch& events,
                  double /*first_step_s*/) override {
    actuation = &inputs;
    watch = &events;
    store(motion, inner, N_VGetArrayPointer(y));
    must(CVodeReInit(cvode, 0, y), "restart");
    if (const bool wanted = events.active(); wanted != rooting) {
      must(CVodeRootInit(cvode, wanted ? static_cast<int>(kDistances) : 0, wanted ? distances : nullptr),
           "root search");
      rooting = wanted;
    }
    realtype reached = 0;
    const int flag = CVode(cvode, span_s, y, &reached, CV_NORMAL);
    must(flag, "integration");
    motion = motion_of(N_VGetArrayPointer(y), inner);
    if (flag == CV_ROOT_RETURN) return {.elapsed_s = reached, .event = found(), .next_first_step_s = span_s};
    return {.elapsed_s = span_s, .event = std::nullopt, .next_first_step_s = span_s};
  }
  [[nodiscard]] long evaluations() const noexcept override { return count; }

 private:
  [[nodiscard]] SUNMatrix new_dense_matrix() const {
    const auto size = static_cast<sunindextype>(2 * half);
    return SUNDenseMatrix(size, size, context);
  }

  [[nodiscard]] AllCoordinates accelerations(const realtype* at) {
    ++count;
    const Motion motion = motion_of(at, inner);
    plant::InnerAccelerations own{};
    const plant::Accelerations a = model.accelerations(motion.state, *actuation, motion.inner, own);
    AllCoordinates all{a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
    std::copy_n(own.begin(), inner, all.begin() + kCoordinates);
    return all;
  }

  static int derivative(realtype /*t*/, N_Vector y, N_Vector dydt, void* user) {
    auto& self = *static_cast<CvodeSolver*>(user);
    const realtype* at = N_VGetArrayPointer(y);
    realtype* out = std::copy_n(at + self.half, self.half, N_VGetArrayPointer(dydt));
    std::copy_n(self.accelerations(at).begin(), self.half, out);
    return 0;
  }

  /// Jacobian by forward differences. The step is small compared with every smoothing speed of the terms.
  static int jacobian(realtype /*t*/, N_Vector y, N_Vector dydt, SUNMatrix matrix, void* user,
                      N_Vector /*w1*/, N_Vector /*w2*/, N_Vector /*w3*/) {
    constexpr double kStep = 1.5e-8;  // square root of the machine epsilon
    auto& self = *static_cast<CvodeSolver*>(user);
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
    const auto& self = *static_cast<const CvodeSolver*>(user);
    measure_distances(*self.watch, N_VGetArrayPointer(y), self.half, distance);
    return 0;
  }

  [[nodiscard]] std::optional<Event> found() const {
    std::array<int, kDistances> roots{};
    must(CVodeGetRootInfo(cvode, roots.data()), "root info");
    const auto first = std::find_if(roots.begin(), roots.end(), [](int root) { return root != 0; });
    if (first == roots.end()) return std::nullopt;
    return event_of(static_cast<std::size_t>(first - roots.begin()));
  }

  const plant::Model& model;
  const std::size_t inner, half;  ///< number of inner coordinates; number of all coordinates
  const plant::Actuation* actuation = nullptr;
  const Watch* watch = nullptr;
  long count = 0;
  bool rooting = false;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* cvode = nullptr;
};

}  // namespace

std::unique_ptr<Solver> make_cvode_solver(const plant::Model& model, const Tolerances& tolerances) {
  return std::make_unique<CvodeSolver>(model, tolerances);
}

}  // namespace crane::simulator
