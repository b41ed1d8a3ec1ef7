#pragma once
/// The crane of a hypothesis as a system of first order: the equations of plant/model, the terms of the
/// hypothesis, one unknown force d per degree of freedom (Ornstein-Uhlenbeck) and dry friction as a
/// regularised set-valued law.
#include <vector>

#include "crane/plant/equations.hpp"
#include "model/parameter.hpp"

namespace crane::innovations {

/// Coordinates in the order of plant::Forces.
enum Coordinate : std::size_t { kX = 0, kPhi = 1, kGamma = 2, kTheta = 3 };
inline constexpr std::size_t kNone = 99;
/// Channel that measures a coordinate, and the other way about.
inline constexpr std::array<std::size_t, 4> kChannelOf{0, 2, 1, 3};
inline constexpr std::array<std::size_t, 4> kCoordinateOf{kX, kGamma, kPhi, kTheta};

/// Which coordinates the state has, as blocks (q, q', d); then (angle, rate) of the lower cable per direction
/// of swing where the load is a double pendulum.
struct Layout {
  std::array<std::size_t, 4> begin{kNone, kNone, kNone, kNone};  ///< by Coordinate
  std::array<std::size_t, 2> lower{kNone, kNone};                ///< by direction of swing
  std::array<bool, 2> volts{};                                   ///< the drive's command is known
  std::size_t size = 0;

  [[nodiscard]] bool has(std::size_t coordinate) const { return begin[coordinate] != kNone; }
  [[nodiscard]] bool planar() const { return has(kPhi) && !has(kTheta) && !has(kGamma); }
};
[[nodiscard]] Layout layout_of(const runtime::Rig& rig, const std::vector<Run>& runs, bool double_pendulum);

/// What the rig file says beyond plant::Parameters, in the form that the filter needs.
struct Nominal {
  struct Friction {
    std::array<double, 2> dry{}, viscous{}, excess{};  ///< towards +, towards -; V, V s/unit, V
    double excess_speed = 0.005;
  };
  struct Ripple {
    double amplitude_v = 0, phase_rad = 0, wave_number = 1;
  };
  plant::Parameters plant;
  std::array<Friction, 2> friction;
  std::array<std::vector<Ripple>, 2> ripples;
  double cable_m = 1;
  std::vector<std::string> ignored;  ///< terms that this engine does not know
};
/// @param values takes the amounts of the terms that are parameters here, too
[[nodiscard]] Nominal nominal_of(const runtime::Rig& rig, Values& values);

class CraneModel {
 public:
  CraneModel(const Nominal& nominal, const Layout& layout, const Values& values, const Scales& scales);

  void set_cable(double cable_m, double cable_mps) { cable_m_ = cable_m, cable_mps_ = cable_mps; }
  /// @param soft width of each drive's step of dry friction [unit/s]
  void rate(const double* s, const std::array<double, 2>& volts, const std::array<double, 2>& soft,
            double* r) const;

  /// What dry friction of one drive opposes with. At rest it cancels what is applied, so that rest says
  /// nothing about the unknown force; it breaks loose without delay; at speed it is c sign(v):
  ///   f = c sat(applied / c + v / soft)
  /// @param applied volts of everything else that pushes the axis
  [[nodiscard]] double dry_friction_v(std::size_t drive, double position, double speed, double applied,
                                      double carried, double soft) const;

  const Layout layout;

 private:
  struct Pushed;
  [[nodiscard]] plant::State state_of(const double* s) const;
  [[nodiscard]] double smooth_volts(std::size_t drive, double position, double speed) const;
  [[nodiscard]] double turn_volts(std::size_t drive, double position) const;
  [[nodiscard]] Eigen::Vector3d load_force(const double* s, const plant::State& state) const;
  void lower_cable(const double* s, const plant::State& state, const Eigen::Vector3d& force,
                   plant::Forces& sum, double* r) const;
  void rub(const double* s, const plant::State& state, const std::array<double, 2>& volts,
           const std::array<double, 2>& soft, plant::Accelerations& a) const;
  void add_lower_rates(const double* s, const plant::State& state, const plant::Accelerations& a,
                       double* r) const;

  const Nominal& nominal_;
  const Values& p_;
  plant::Parameters plant_;
  plant::Locks locks_;
  std::array<double, 2> per_volt_{};    ///< N or N m per V
  std::array<double, 4> forgetting_{};  ///< 1 / correlation time, by coordinate
  std::array<bool, 2> rubs_{};
  double cable_m_, cable_mps_ = 0, pivot_soft_;
  double lower_kg_ = 0, lower_m_ = 1;
};

}  // namespace crane::innovations
