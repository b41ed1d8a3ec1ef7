#pragma once
/// The moving crane: MuJoCo computes the rigid bodies, this code computes the forces, and one Runge-Kutta
/// step integrates both.
///
/// MuJoCo contains no equations of a crane. From a tree of bodies (jib, trolley, load, and an additional body
/// if the fault divides a body) with their masses, MuJoCo computes M(q) and the Coriolis forces recursively.
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

/// Inner states of a drive in addition to the coordinates of MuJoCo: friction, hose, lag.
inline constexpr std::size_t kInner = 3;

/// Disturbing forces. They depend on time only, so that they are equal with and without a fault.
struct Disturbance {
  std::function<std::array<double, 2>(double)> load_n;  ///< along and across the jib
  std::function<std::array<double, kAxes>(double)> drive_v;
};

/// Motor positions and swing angles with their rates, without sensor errors.
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

  /// All states that the pose does not contain are initially at rest.
  void start(const Pose& pose, double time_s = 0);
  /// The command that already acts at the start.
  void holding(const std::array<double, kAxes>& volts);
  /// The command from now on; delay and lag of the fault act in addition.
  void command(const std::array<double, kAxes>& volts);
  /// Integrates to `time_s`; `seen` is called after every step.
  void advance(double time_s, const Disturbance& disturbance,
               const std::function<void(double, const Pose&)>& seen);

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] Pose pose() const;
  [[nodiscard]] double energy_j() const;

 private:
  struct Joints {
    std::array<int, kAxes> motor{-1, -1}, far{-1, -1};  ///< far: load side of a gap or a flexible jib
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
