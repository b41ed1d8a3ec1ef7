/// One tick (10 ms) of a gantry without friction: MuJoCo's Runge-Kutta integrator, CVODE and the fast method,
/// with the same model and the same error. The label is the largest difference of positions to a CVODE
/// solution with tolerance 1e-12 over 2 s, in m and rad.
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "crane/simulator/integrator.hpp"

namespace {

namespace plant = crane::plant;
namespace simulator = crane::simulator;

using Motion = std::vector<std::array<double, 2>>;  ///< trolley, radial swing; one per tick

constexpr int kTicks = 200;
constexpr double kTick_s = 0.01;
const plant::Parameters kGantry{
    .trolley_inertia_kg = 12, .trolley_mass_kg = 4, .load_mass_kg = 3, .trolley_gain_mps2pv = 1.2};
const plant::State kStart{.trolley_m = 0.5, .radial_rad = 0.2, .cable_m = 1};

double command_v(int tick) { return 2 * std::sin(0.03 * tick); }

class ByPlant {
 public:
  explicit ByPlant(simulator::Method method, const simulator::Tolerances& tolerances = {})
      : model_{kGantry}, integrator_{model_, tolerances, method} {}
  void start() { state_ = kStart; }
  void tick(int number) {
    plant::Actuation actuation;
    actuation.drive_v[plant::kTrolley] = command_v(number);
    actuation.locks.axis = {false, true, true};
    actuation.locks.tangential = true;
    integrator_.advance(state_, actuation, kTick_s);
  }
  [[nodiscard]] std::array<double, 2> position() const { return {state_.trolley_m, state_.radial_rad}; }

 private:
  plant::Model model_;
  simulator::Integrator integrator_;
  plant::State state_;
};

class ByMujoco {
 public:
  explicit ByMujoco(int steps)
      : model_{compiled(), mj_deleteModel}, data_{mj_makeData(model_.get()), mj_deleteData} {
    model_->opt.integrator = mjINT_RK4;
    model_->opt.timestep = kTick_s / steps;
    steps_ = steps;
  }
  void start() {
    mj_resetData(model_.get(), data_.get());
    data_->qpos[0] = kStart.trolley_m;
    data_->qpos[1] = kStart.radial_rad;
  }
  void tick(int number) {
    data_->qfrc_applied[0] = kGantry.trolley_inertia_kg * kGantry.trolley_gain_mps2pv * command_v(number);
    for (int i = 0; i < steps_; ++i) mj_step(model_.get(), data_.get());
  }
  [[nodiscard]] std::array<double, 2> position() const { return {data_->qpos[0], data_->qpos[1]}; }

 private:
  static mjModel* compiled() {
    mujoco_truth::Physics physics;
    physics.rig.kind = mujoco_truth::Kind::gantry;
    physics.rig.drive[mujoco_truth::kTrolley] = {.there = true, .inertia_kg = kGantry.trolley_inertia_kg};
    physics.rig.trolley_mass_kg = kGantry.trolley_mass_kg;
    physics.rig.load_mass_kg = kGantry.load_mass_kg;
    const std::string xml = mujoco_truth::bodies_xml(physics);
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "gantry.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "gantry.xml")], xml.data(), xml.size());
    char error[500] = "";
    mjModel* model = mj_loadXML("gantry.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(std::string{"MuJoCo: "} + error);
    return model;
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  int steps_ = 1;
};

template <class Simulation>
Motion motion_of(Simulation& simulation) {
  Motion motion;
  simulation.start();
  for (int tick = 0; tick < kTicks; ++tick) {
    simulation.tick(tick);
    motion.push_back(simulation.position());
  }
  return motion;
}

template <class Simulation>
double error_of(Simulation& simulation) {
  ByPlant reference{simulator::Method::cvode, {.relative = 1e-12, .absolute = 1e-12}};
  const Motion exact = motion_of(reference), motion = motion_of(simulation);
  double largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k) largest = std::max(largest, std::abs(motion[i][k] - exact[i][k]));
  return largest;
}

template <class Simulation>
void measure(benchmark::State& run, Simulation& simulation) {
  run.counters["error"] = error_of(simulation);
  simulation.start();
  int tick = 0;
  for (auto step : run) {
    if (tick == kTicks) simulation.start(), tick = 0;
    simulation.tick(tick++);
    benchmark::DoNotOptimize(simulation.position());
  }
}

void cvode(benchmark::State& run) {
  ByPlant simulation{simulator::Method::cvode};
  measure(run, simulation);
}
BENCHMARK(cvode);
void fast(benchmark::State& run) {
  ByPlant simulation{simulator::Method::fast};
  measure(run, simulation);
}
BENCHMARK(fast);

/// The argument is the number of steps per tick.
void mujoco_runge_kutta(benchmark::State& run) {
  ByMujoco simulation{static_cast<int>(run.range(0))};
  measure(run, simulation);
}
BENCHMARK(mujoco_runge_kutta)->RangeMultiplier(2)->Range(1, 16);

/// The fewest steps with which the error is not larger than that of the fast method.
void mujoco_with_the_error_of_fast(benchmark::State& run) {
  // Both methods reach the error of the reference; a difference of a few percent is not significant.
  constexpr double kAsExact = 1.1;
  ByPlant own{simulator::Method::fast};
  const double permitted = kAsExact * error_of(own);
  int steps = 1;
  for (; steps < 1024; steps *= 2) {
    ByMujoco mujoco{steps};
    if (error_of(mujoco) <= permitted) break;
  }
  run.counters["steps"] = steps;
  ByMujoco simulation{steps};
  measure(run, simulation);
}
BENCHMARK(mujoco_with_the_error_of_fast);

}  // namespace
