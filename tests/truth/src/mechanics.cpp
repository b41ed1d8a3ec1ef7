#include "mechanics.hpp"

#include <cmath>

namespace truth {
namespace {

/// Share of the slew inertia on the motor side of an elastic connection or a gap.
constexpr double kMotorShare = 0.35;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
void add(Vector& sum, double factor, const Vector& a) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] += factor * a[i];
}

/// Direction of a cable with its derivatives by the two angles.
struct Direction {
  Direction(double phi, double theta) {
    const double sf = std::sin(phi), cf = std::cos(phi), st = std::sin(theta), ct = std::cos(theta);
    u = {-ct * sf, st, -ct * cf};
    by_phi = {-ct * cf, 0, ct * sf};
    by_theta = {st * sf, ct, st * cf};
    by_phi_theta = {st * cf, 0, -st * sf};
    by_phi_phi = {ct * sf, 0, ct * cf};
    by_theta_theta = {ct * sf, -st, ct * cf};
  }
  Vector u, by_phi, by_theta, by_phi_phi, by_phi_theta, by_theta_theta;
};

}  // namespace

Mechanics::Mechanics(const Physics& physics) : physics_(physics) {
  up_ = {-std::sin(physics.tilt_rad), 0, std::cos(physics.tilt_rad)};
  add(gravity_, -physics.gravity_mps2, up_);
  length_m_ = physics.cable_m + physics.cable_error_m;
  const Drive &trolley = physics.drive[0], &slew = physics.drive[1];
  const bool load = physics.load_kg > 0, sling = load && physics.sling_m > 0;
  moves_[kMotorX] = trolley.present;
  moves_[kMotorSlew] = slew.present;
  moves_[kCarriage] = trolley.present && (trolley.gap > 0 || trolley.stiffness > 0);
  moves_[kJib] = slew.present && (slew.gap > 0 || slew.stiffness > 0);
  moves_[kRadial] = load && physics.radial;
  moves_[kTangential] = load && physics.tangential;
  moves_[kCable] = load && physics.cable_stiffness_n > 0;
  moves_[kRadial2] = sling && physics.radial;
  moves_[kTangential2] = sling && physics.tangential;
  for (std::size_t i = 0; i < kCoordinates; ++i) {
    stands_for_[i] = i;
    if (moves_[i]) moving_.push_back(i);
  }
  if (!moves_[kCarriage]) stands_for_[kCarriage] = kMotorX;
  if (!moves_[kJib]) stands_for_[kJib] = kMotorSlew;
}

Mechanics::Point Mechanics::carriage(const Coordinates& q, const Coordinates& rate) const {
  Point point;
  point.mass_kg = physics_.carriage_kg;
  point.position = {q[of(kCarriage)], 0, 0};
  point.jacobian[of(kCarriage)] = {1, 0, 0};
  turn(point, rate);
  return point;
}

/// Moves the point to the lower end of a cable that hangs from it, in the frame of the jib.
void Mechanics::hang(Point& point, double length, bool elastic, std::size_t radial, std::size_t tangential,
                     const Coordinates& q, const Coordinates& rate) const {
  const Direction d{q[radial], q[tangential]};
  const double f = rate[radial], t = rate[tangential];
  add(point.position, length, d.u);
  add(point.jacobian[radial], length, d.by_phi);
  add(point.jacobian[tangential], length, d.by_theta);
  add(point.bias, length * f * f, d.by_phi_phi);
  add(point.bias, 2 * length * f * t, d.by_phi_theta);
  add(point.bias, length * t * t, d.by_theta_theta);
  if (!elastic) return;
  add(point.jacobian[kCable], 1, d.u);
  add(point.bias, 2 * rate[kCable] * f, d.by_phi);
  add(point.bias, 2 * rate[kCable] * t, d.by_theta);
}

/// Converts from the frame of the jib to velocities and accelerations relative to the ground: w x r, 2 w x
/// r', w x (w x r). The jib turns about the vertical, also when it is tilted.
void Mechanics::turn(Point& point, const Coordinates& rate) const {
  const double w = rate[of(kJib)];
  Vector relative{};
  for (const std::size_t i : moving_) add(relative, rate[i], point.jacobian[i]);
  const Vector moved = cross(up_, point.position);
  const Vector coriolis = cross(up_, relative), centripetal = cross(up_, moved);
  for (std::size_t i = 0; i < 3; ++i) point.bias[i] += 2 * w * coriolis[i] + w * w * centripetal[i];
  add(point.jacobian[of(kJib)], 1, moved);
}

Mechanics::Points Mechanics::points(const Coordinates& q, const Coordinates& rate) const {
  Points all;
  all.point[all.count++] = carriage(q, rate);
  if (physics_.load_kg <= 0) return all;
  Point load;
  load.mass_kg = physics_.load_kg;
  load.position = {q[of(kCarriage)], 0, 0};
  load.jacobian[of(kCarriage)] = {1, 0, 0};
  const bool elastic = moves_[kCable];
  hang(load, elastic ? q[kCable] : length_m_ - physics_.sling_m, elastic, kRadial, kTangential, q, rate);
  if (physics_.sling_m > 0) {
    Point hook = load;
    hook.mass_kg = physics_.hook_kg;
    load.mass_kg -= physics_.hook_kg;
    turn(hook, rate);
    all.point[all.count++] = hook;
    hang(load, physics_.sling_m, false, kRadial2, kTangential2, q, rate);
  }
  turn(load, rate);
  all.point[all.count++] = load;
  return all;
}

std::array<double, kCoordinates> Mechanics::own_inertia() const {
  std::array<double, kCoordinates> inertia{};
  inertia[kMotorX] = physics_.trolley_inertia_kg - physics_.carriage_kg;
  inertia[kMotorSlew] = physics_.jib_kgm2;
  if (moves_[kJib]) {
    inertia[kMotorSlew] = kMotorShare * physics_.jib_kgm2;
    inertia[kJib] = (1 - kMotorShare) * physics_.jib_kgm2;
  }
  return inertia;
}

LoadMotion Mechanics::load(const Coordinates& q, const Coordinates& rate) const {
  const Points all = points(q, rate);
  const Point& last = all.point[all.count - 1];
  LoadMotion motion{last.position, {}};
  for (const std::size_t i : moving_) add(motion.velocity_mps, rate[i], last.jacobian[i]);
  return motion;
}

Coordinates Mechanics::accelerations(const Coordinates& q, const Coordinates& rate,
                                     const Acting& acting) const {
  const Points all = points(q, rate);
  const auto own = own_inertia();
  const std::size_t n = moving_.size();
  std::array<std::array<double, kCoordinates>, kCoordinates> a;
  Coordinates b;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t row = moving_[i];
    b[i] = acting.generalised[row];
    for (std::size_t j = 0; j <= i; ++j) a[i][j] = i == j ? own[row] : 0;
    for (std::size_t k = 0; k < all.count; ++k) {
      const Point& p = all.point[k];
      const Vector& column = p.jacobian[row];
      if (column[0] == 0 && column[1] == 0 && column[2] == 0) continue;
      for (std::size_t j = 0; j <= i; ++j) a[i][j] += p.mass_kg * dot(column, p.jacobian[moving_[j]]);
      b[i] += p.mass_kg * (dot(column, gravity_) - dot(column, p.bias));
    }
    b[i] += dot(all.point[all.count - 1].jacobian[row], acting.load_n);
  }
  for (std::size_t i = 0; i < n; ++i) {  // Cholesky decomposition with forward substitution
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
      a[i][i] -= a[i][j] * a[i][j];
      b[i] -= a[i][j] * b[j];
    }
    a[i][i] = std::sqrt(a[i][i]);
    b[i] /= a[i][i];
  }
  Coordinates result{};
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
    result[moving_[i]] = b[i];
  }
  return result;
}

double Mechanics::energy_j(const Coordinates& q, const Coordinates& rate) const {
  const Points all = points(q, rate);
  const auto own = own_inertia();
  double energy = 0;
  for (const std::size_t i : moving_) energy += 0.5 * own[i] * rate[i] * rate[i];
  for (std::size_t k = 0; k < all.count; ++k) {
    const Point& p = all.point[k];
    Vector v{};
    for (const std::size_t i : moving_) add(v, rate[i], p.jacobian[i]);
    energy += p.mass_kg * (0.5 * dot(v, v) - dot(gravity_, p.position));
  }
  return energy;
}

}  // namespace truth
