#include "shooting/equation_error.hpp"

namespace crane::diagnosis {
namespace {

/// The last window of the run that begins before the middle of the piece.
std::size_t window_of(const std::vector<Window>& windows, const Piece& piece) {
  const std::size_t middle = piece.first + piece.rows / 2;
  std::size_t found = 0;
  for (std::size_t w = 0; w < windows.size(); ++w)
    if (windows[w].run == piece.run && (windows[w].first <= middle || windows[found].run != piece.run))
      found = w;
  return found;
}

}  // namespace

EquationError::EquationError(const Problem& drive, const Replays& crane) : drive_(drive) {
  if (drive_.empty()) return;
  for (const Output axis : drive_.outputs()) axes_.push_back(pieces_of(drive_.runs(), crane, axis));
  find_windows();
}

EquationError::EquationError(const Problem& drive, const std::vector<Disturbance>& disturbances,
                             const Replays& crane)
    : drive_(drive) {
  if (drive_.empty()) return;
  for (std::size_t i = 0; i < disturbances.size(); ++i)
    axes_.push_back(pieces_of(drive_.runs(), crane, drive_.outputs()[i], disturbances[i]));
  find_windows();
}

std::vector<Disturbance> EquationError::disturbances() const {
  std::vector<Disturbance> all;
  for (const Pieces& axis : axes_) all.push_back(axis.disturbance);
  return all;
}

std::vector<Disturbance> EquationError::disturbances_of(const Replays& crane,
                                                        const std::vector<Disturbance>& near) const {
  std::vector<Disturbance> all;
  if (drive_.empty()) return all;
  for (std::size_t i = 0; i < drive_.outputs().size(); ++i)
    all.push_back(
        disturbance_of(drive_.runs(), crane, drive_.outputs()[i], near.empty() ? Disturbance{} : near[i]));
  return all;
}

void EquationError::find_windows() {
  for (const Pieces& axis : axes_)
    for (const Piece& piece : axis.all) windows_.push_back(window_of(drive_.windows(), piece));
}

std::vector<double> EquationError::log_variances() const {
  std::vector<double> all;
  for (const Pieces& axis : axes_)
    for (const Piece& piece : axis.all) {
      double sum = 0;
      for (std::size_t row = 0; row < piece.rows; ++row) sum += piece.whitener.log_variance(row);
      all.push_back(sum);
    }
  return all;
}

std::vector<Eigen::VectorXd> EquationError::plain_residuals(const Replays& crane) const {
  std::vector<Eigen::VectorXd> all;
  for (const Pieces& axis : axes_)
    for (Eigen::VectorXd& residual : plain_residuals_of(axis, crane)) all.push_back(std::move(residual));
  return all;
}

std::vector<Eigen::VectorXd> EquationError::whitened(const std::vector<Eigen::VectorXd>& plain) const {
  std::vector<Eigen::VectorXd> all;
  auto next = plain.begin();
  for (const Pieces& axis : axes_) {
    const auto end = next + static_cast<std::ptrdiff_t>(axis.all.size());
    for (Eigen::VectorXd& residual : diagnosis::whitened(axis, {next, end}))
      all.push_back(std::move(residual));
    next = end;
  }
  return all;
}

std::vector<Eigen::VectorXd> EquationError::residuals(const Replays& crane) const {
  return whitened(plain_residuals(crane));
}

std::vector<Eigen::VectorXd> EquationError::change(const Replays& crane,
                                                   const std::vector<Eigen::VectorXd>& at,
                                                   double step) const {
  std::vector<Eigen::VectorXd> changes = residuals(crane);
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i] = (at[i] - changes[i]) / step;
  return changes;
}

}  // namespace crane::diagnosis
