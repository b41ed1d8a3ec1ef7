#include "crane.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "bodies.hpp"
#include "friction.hpp"

namespace mujoco_truth {
namespace {

mjModel* compiled(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "crane.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "crane.xml")], xml.data(), xml.size());
  char error[500] = "";
  mjModel* model = mj_loadXML("crane.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(std::string{"MuJoCo: "} + error);
  return model;
}

}  // namespace

const char* name_of(Kind kind) {
  return std::array{"tower", "gantry", "drive_axis", "pendulum"}[static_cast<std::size_t>(kind)];
}

const char* name_of(StandstillLaw law) {
  return std::array{"dahl", "lugre", "elasto_plastic"}[static_cast<std::size_t>(law)];
}

Crane::Crane(const Physics& physics)
    : physics_(physics),
      model_(compiled(bodies_xml(physics)), mj_deleteModel),
      data_(mj_makeData(model_.get()), mj_deleteData) {
  const auto dof = [&](const std::string& name) {
    const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, name.c_str());
    return joint < 0 ? -1 : model_->jnt_dofadr[joint];
  };
  for (std::size_t i = 0; i < kAxes; ++i) {
    joints_.motor[i] = dof(kAxisNames[i]);
    joints_.far[i] = dof(std::string{kAxisNames[i]} + "_far");
  }
  for (std::size_t i = 0; i < kSwings; ++i) joints_.swing[i] = dof(kSwingNames[i]);
  joints_.load_body = mj_name2id(model_.get(), mjOBJ_BODY, "load");
}

Crane::~Crane() = default;

void Crane::start(const Pose& pose, double time_s) {
  const auto nv = static_cast<std::size_t>(model_->nv);
  state_.assign(2 * nv + kInner * kAxes, 0);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (joints_.motor[i] >= 0) {
      state_[static_cast<std::size_t>(joints_.motor[i])] = pose.position[i];
      state_[nv + static_cast<std::size_t>(joints_.motor[i])] = pose.speed[i];
      // The friction of an axis that initially moves is fully developed.
      state_[2 * nv + kInner * i] = sign_of(pose.speed[i]);
    }
  for (std::size_t i = 0; i < kSwings; ++i)
    if (joints_.swing[i] >= 0) {
      state_[static_cast<std::size_t>(joints_.swing[i])] = pose.swing[i];
      state_[nv + static_cast<std::size_t>(joints_.swing[i])] = pose.rate[i];
    }
  time_s_ = time_s;
  acting_v_ = {};
  for (auto& queue : pending_) queue.clear();
}

void Crane::holding(const std::array<double, kAxes>& volts) {
  acting_v_ = volts;
  const auto nv = static_cast<std::size_t>(model_->nv);
  for (std::size_t i = 0; i < kAxes; ++i) state_[2 * nv + kInner * i + 2] = effective_v(i);
}

void Crane::command(const std::array<double, kAxes>& volts) {
  for (std::size_t i = 0; i < kAxes; ++i)
    pending_[i].push_back({time_s_ + physics_.drive[i].delay_s, volts[i]});
}

void Crane::slope(const State& state, double time_s, const Disturbance& disturbance, State& out) {
  mjModel* m = model_.get();
  mjData* d = data_.get();
  const auto nv = static_cast<std::ptrdiff_t>(m->nv);
  std::copy_n(state.begin(), nv, d->qpos);
  std::copy_n(state.begin() + nv, nv, d->qvel);
  mj_fwdPosition(m, d);
  mj_fwdVelocity(m, d);
  std::fill_n(d->qfrc_applied, nv, 0.0);
  apply_drive_forces(state, time_s, disturbance, out);
  if (joints_.load_body >= 0) apply_load_forces(time_s, disturbance);
  mj_fwdActuation(m, d);
  mj_fwdAcceleration(m, d);
  mj_fwdConstraint(m, d);
  std::copy_n(state.begin() + nv, nv, out.begin());
  std::copy_n(d->qacc, nv, out.begin() + nv);
}

void Crane::wear_bristles(double h) {
  const auto nv = static_cast<std::size_t>(model_->nv);
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (joints_.motor[i] < 0) continue;
    const double speed = state_[nv + static_cast<std::size_t>(joints_.motor[i])];
    double* inner = &state_[2 * nv + kInner * i];
    inner[0] =
        bristle_after(physics_.law, inner[0], speed, ceiling(i, inner[0], speed), physics_.presliding_m, h);
    inner[1] = bristle_after(StandstillLaw::dahl, inner[1], speed, 1, physics_.drive[i].hose_way, h);
  }
}

void Crane::step(double h, const Disturbance& disturbance) {
  // Leapfrog: half a step of the bristles, a classical Runge-Kutta step of all other states, half a step of
  // the bristles.
  wear_bristles(h / 2);
  slope_.resize(state_.size());
  sum_.assign(state_.size(), 0);
  stage_ = state_;
  constexpr std::array kAt{0.0, 0.5, 0.5, 1.0}, kWeight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  for (std::size_t s = 0; s < 4; ++s) {
    if (s > 0)
      for (std::size_t i = 0; i < state_.size(); ++i) stage_[i] = state_[i] + kAt[s] * h * slope_[i];
    slope(stage_, time_s_ + kAt[s] * h, disturbance, slope_);
    for (std::size_t i = 0; i < state_.size(); ++i) sum_[i] += kWeight[s] * slope_[i];
  }
  for (std::size_t i = 0; i < state_.size(); ++i) state_[i] += h * sum_[i];
  wear_bristles(h / 2);
  time_s_ += h;
}

void Crane::advance(double time_s, const Disturbance& disturbance,
                    const std::function<void(double, const Pose&)>& seen) {
  constexpr double kSame_s = 1e-9;
  while (time_s_ < time_s - kSame_s) {
    double until = time_s;
    for (std::size_t i = 0; i < kAxes; ++i) {
      auto& queue = pending_[i];
      while (!queue.empty() && queue.front()[0] <= time_s_ + kSame_s) {
        acting_v_[i] = queue.front()[1];
        queue.pop_front();
      }
      if (!queue.empty()) until = std::min(until, queue.front()[0]);
    }
    const double steps = std::ceil((until - time_s_) / kStep_s - 1e-6);
    step(std::min(kStep_s, (until - time_s_) / std::max(1.0, steps)), disturbance);
    if (seen) seen(time_s_, pose());
  }
  time_s_ = time_s;
}

Pose Crane::pose() const {
  const auto nv = static_cast<std::size_t>(model_->nv);
  Pose pose;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (joints_.motor[i] >= 0) {
      pose.position[i] = state_[static_cast<std::size_t>(joints_.motor[i])];
      pose.speed[i] = state_[nv + static_cast<std::size_t>(joints_.motor[i])];
    }
  for (std::size_t i = 0; i < kSwings; ++i)
    if (joints_.swing[i] >= 0) {
      pose.swing[i] = state_[static_cast<std::size_t>(joints_.swing[i])];
      pose.rate[i] = state_[nv + static_cast<std::size_t>(joints_.swing[i])];
    }
  return pose;
}

double Crane::energy_j() const {
  mjModel* m = model_.get();
  mjData* d = data_.get();
  const auto nv = static_cast<std::size_t>(m->nv);
  std::copy_n(state_.begin(), nv, d->qpos);
  std::copy_n(state_.begin() + static_cast<std::ptrdiff_t>(nv), nv, d->qvel);
  mj_fwdPosition(m, d);
  mj_fwdVelocity(m, d);
  mj_energyPos(m, d);
  mj_energyVel(m, d);
  return d->energy[0] + d->energy[1];
}

}  // namespace mujoco_truth
