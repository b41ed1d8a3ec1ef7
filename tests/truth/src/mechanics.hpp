#pragma once
/// Equations of motion by Kane's method: every point mass contributes m J^T J to the mass matrix and
/// -m J^T (c - g) to the forces, where its velocity is J q' and its acceleration J q'' + c.
#include <array>
#include <vector>

#include "truth/physics.hpp"

namespace truth {

using Vector = std::array<double, 3>;

/// Coordinates. A rig without elasticity has the first four coordinates; carriage and jib then move with
/// their motors.
enum Coordinate : std::size_t {
  kMotorX,
  kMotorSlew,
  kRadial,
  kTangential,
  kCarriage,
  kJib,
  kCable,
  kRadial2,
  kTangential2
};
inline constexpr std::size_t kCoordinates = 9;
using Coordinates = std::array<double, kCoordinates>;

/// Forces in addition to gravity at this instant.
struct Acting {
  Coordinates generalised{};  ///< N, N m
  Vector load_n{};            ///< force on the load, in the jib's frame
};

struct LoadMotion {
  Vector position_m{}, velocity_mps{};  ///< in the jib's frame, velocity over ground
};

class Mechanics {
 public:
  explicit Mechanics(const Physics& physics);

  /// Selection of the independent coordinates.
  [[nodiscard]] bool moves(Coordinate c) const { return moves_[c]; }
  /// Index of the coordinate that represents `c`: that of the motor if carriage or jib are rigidly coupled.
  [[nodiscard]] std::size_t of(Coordinate c) const { return stands_for_[c]; }
  [[nodiscard]] const std::vector<std::size_t>& moving() const { return moving_; }

  [[nodiscard]] LoadMotion load(const Coordinates& q, const Coordinates& rate) const;
  [[nodiscard]] Coordinates accelerations(const Coordinates& q, const Coordinates& rate,
                                          const Acting& acting) const;
  /// Kinetic energy plus potential energy of gravity; the caller adds the energy of springs.
  [[nodiscard]] double energy_j(const Coordinates& q, const Coordinates& rate) const;

 private:
  struct Point {
    double mass_kg = 0;
    Vector position{};
    std::array<Vector, kCoordinates> jacobian{};
    Vector bias{};  ///< c
  };
  [[nodiscard]] Point carriage(const Coordinates& q, const Coordinates& rate) const;
  void hang(Point& point, double length_m, bool elastic, std::size_t radial, std::size_t tangential,
            const Coordinates& q, const Coordinates& rate) const;
  void turn(Point& point, const Coordinates& rate) const;
  struct Points {
    std::array<Point, 3> point;
    std::size_t count = 0;
  };
  [[nodiscard]] Points points(const Coordinates& q, const Coordinates& rate) const;
  [[nodiscard]] std::array<double, kCoordinates> own_inertia() const;

  Physics physics_;
  Vector up_{}, gravity_{};  ///< in the jib's frame
  std::array<bool, kCoordinates> moves_{};
  std::array<std::size_t, kCoordinates> stands_for_{};
  std::vector<std::size_t> moving_;
  double length_m_ = 1;
};

}  // namespace truth
