#pragma once
/// The moving crane: rigid bodies by MuJoCo, forces of our own, both under one Runge-Kutta step.
///
/// MuJoCo has no equations of a crane. It gets a tree of bodies (jib, trolley, load, and a second body where
/// the fault divides one) with their masses, and forms M(q) and the Coriolis forces by recursion over the
/// tree.
#include <deque>
#include <functional>
#include <memory>

#include "physics.hpp"

struct mjModel_;
struct mjData_;

namespace mujoco_truth {

/// Integration step, s: a bristle of 10 um that holds 3.6 m/s2 rings at 600 rad/s; the leapfrog is stable to
/// 2 / 600 s.
inline constexpr double kStep_s = 1e-3;

/// Inner states of a drive beside MuJoCo's coordinates: friction, hose, lag.
inline constexpr std::size_t kInner = 3;

/// Forces that no model knows: of time only, so that the same ones act with and without a fault.
struct Disturbance {
  std::function<std::array<double, 2>(double)> load_n;  ///< along and across the jib
  std::function<std::array<double, kAxes>(double)> drive_v;
};

/// Motor positions and swing angles with their rates, as perfect sensors would see them.
struct Pose {
  std::array<double, kAxes> position{}, speed{};
  std::array<double, kSwings> swing{}, rate{};
};

class Crane {
 public:
  explicit Crane(const Physics& physics);
  ~Crane();
  Crane(const Crane&) = delete;
  Crane& operator=(const Crane&) = delete;

  /// All that the pose does not say is at rest.
  void start(const Pose& pose, double time_s = 0);
  /// What acts already at the start.
  void holding(const std::array<double, kAxes>& volts);
  /// The command that acts from now on; delay and lag of the fault come on top of it.
  void command(const std::array<double, kAxes>& volts);
  /// Integrates to `time_s`; `seen` is called after every step.
  void advance(double time_s, const Disturbance& disturbance,
               const std::function<void(double, const Pose&)>& seen);

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] Pose pose() const;
  [[nodiscard]] double energy_j() const;

 private:
  struct Joints {
    std::array<int, kAxes> motor{-1, -1}, far{-1, -1};  ///< far: beyond a gap or a flexible jib
    std::array<int, kSwings> swing{-1, -1};
    int load_body = -1;
  };
  using State = std::vector<double>;

  void slope(const State& state, double time_s, const Disturbance& disturbance, State& out);
  void apply_drive_forces(const State& state, double time_s, const Disturbance& disturbance, State& out);
  void apply_flanks(std::size_t axis);
  void apply_load_forces(double time_s, const Disturbance& disturbance);
  double drive_force_v(std::size_t axis, double z, double hose, double volts, double time_s) const;
  void wear_bristles(double h);
  void step(double h, const Disturbance& disturbance);
  [[nodiscard]] double ceiling(std::size_t axis, double z, double speed) const;
  [[nodiscard]] double effective_v(std::size_t axis) const;

  Physics physics_;
  std::unique_ptr<mjModel_, void (*)(mjModel_*)> model_;
  std::unique_ptr<mjData_, void (*)(mjData_*)> data_;
  Joints joints_;
  double time_s_ = 0;
  State state_, stage_, sum_, slope_;
  std::array<double, kAxes> acting_v_{};
  std::array<std::deque<std::array<double, 2>>, kAxes> pending_;  ///< time at which it acts, volts
};

}  // namespace mujoco_truth
