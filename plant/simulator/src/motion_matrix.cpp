#include "motion_matrix.hpp"

#include <nvector/nvector_serial.h>

#include <Eigen/LU>
#include <new>

namespace crane::simulator {
namespace {

using Half = Eigen::Matrix<double, kCoordinates, 1>;

struct Factors {
  MotionMatrix matrix;
  Eigen::PartialPivLU<CoordinateMatrix> lu;
};

Factors& factors_of(SUNLinearSolver solver) { return *static_cast<Factors*>(solver->content); }

SUNMatrix_ID custom_id(SUNMatrix /*matrix*/) { return SUNMATRIX_CUSTOM; }
SUNMatrix clone(SUNMatrix matrix) { return new_motion_matrix(matrix->sunctx); }
void destroy_matrix(SUNMatrix matrix) {
  delete static_cast<MotionMatrix*>(matrix->content);
  matrix->content = nullptr;
  SUNMatFreeEmpty(matrix);
}
int zero(SUNMatrix matrix) {
  content_of(matrix) = {};
  return SUNMAT_SUCCESS;
}
int copy(SUNMatrix from, SUNMatrix to) {
  content_of(to) = content_of(from);
  return SUNMAT_SUCCESS;
}
int scale_add_identity(realtype c, SUNMatrix matrix) {
  MotionMatrix& m = content_of(matrix);
  m.scale *= c;
  m.identity = m.identity * c + 1;
  return SUNMAT_SUCCESS;
}

SUNLinearSolver_Type direct(SUNLinearSolver /*solver*/) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID custom_solver_id(SUNLinearSolver /*solver*/) { return SUNLINEARSOLVER_CUSTOM; }

int factorise(SUNLinearSolver solver, SUNMatrix matrix) {
  Factors& f = factors_of(solver);
  f.matrix = content_of(matrix);
  const double g = -f.matrix.scale;
  f.lu.compute(CoordinateMatrix::Identity() - g * f.matrix.by_rate - g * g * f.matrix.by_position);
  return SUNLS_SUCCESS;
}

int solve(SUNLinearSolver solver, SUNMatrix /*matrix*/, N_Vector x, N_Vector b, realtype /*tolerance*/) {
  const Factors& f = factors_of(solver);
  const double g = -f.matrix.scale;
  const Eigen::Map<const Half> r_p{N_VGetArrayPointer(b)};
  const Eigen::Map<const Half> r_v{N_VGetArrayPointer(b) + kCoordinates};
  const Half d_v = f.lu.solve(r_v + g * (f.matrix.by_position * r_p));
  // stored last, because x and b may be the same vector
  const Half d_p = r_p + g * d_v;
  Eigen::Map<Half>{N_VGetArrayPointer(x)} = d_p;
  Eigen::Map<Half>{N_VGetArrayPointer(x) + kCoordinates} = d_v;
  return SUNLS_SUCCESS;
}

int destroy_solver(SUNLinearSolver solver) {
  delete static_cast<Factors*>(solver->content);
  solver->content = nullptr;
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

}  // namespace

SUNMatrix new_motion_matrix(SUNContext context) {
  SUNMatrix matrix = SUNMatNewEmpty(context);
  if (matrix == nullptr) return nullptr;
  matrix->ops->getid = custom_id;
  matrix->ops->clone = clone;
  matrix->ops->destroy = destroy_matrix;
  matrix->ops->zero = zero;
  matrix->ops->copy = copy;
  matrix->ops->scaleaddi = scale_add_identity;
  matrix->content = new (std::nothrow) MotionMatrix{};
  return matrix;
}

MotionMatrix& content_of(SUNMatrix matrix) { return *static_cast<MotionMatrix*>(matrix->content); }

SUNLinearSolver new_motion_solver(SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->ops->gettype = direct;
  solver->ops->getid = custom_solver_id;
  solver->ops->setup = factorise;
  solver->ops->solve = solve;
  solver->ops->free = destroy_solver;
  solver->content = new (std::nothrow) Factors{};
  return solver;
}

}  // namespace crane::simulator
