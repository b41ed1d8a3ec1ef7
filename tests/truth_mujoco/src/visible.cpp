#include "visible.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sensors.hpp"

namespace mujoco_truth {
namespace {

/// Time before a window in which delays and moving averages of sensors are filled.
constexpr double kLeadIn_s = 0.4;
constexpr std::size_t kMostWindows = 6, kMostRows = 120;

struct Channel {
  bool swing;
  std::size_t number;
};

std::vector<Channel> channels_of(const Rig& rig) {
  std::vector<Channel> all;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there) all.push_back({false, i});
  for (std::size_t i = 0; i < kSwings; ++i)
    if (rig.has_swing(i)) all.push_back({true, i});
  return all;
}

}  // namespace

struct Visibility::Window {
  double from_s = 0, cable_m = 1;
  Pose start;
  std::vector<Row> rows;  ///< the row before the window and the rows of the window
  std::vector<double> at_s;
  std::vector<double> base;  ///< rows times channels
  Eigen::MatrixXd starts;    ///< orthonormal basis of the effects of the start, per window
};

namespace {

/// Rows of the window, simulated without noise and quantisation.
std::vector<double> simulated(const Physics& physics, const Pose& start, double from_s,
                              const std::vector<Row>& rows, const std::vector<double>& at_s,
                              const std::vector<Channel>& channels) {
  Physics exact = physics;
  for (Drive& d : exact.rig.drive) d.counts_per_m = 0;
  exact.rig.swing_counts_per_rad = 0;
  Crane crane(exact);
  Chance none(1, "");
  Sensors sensors(exact, 0, none);
  crane.start(start, from_s);
  crane.holding(rows.front().command_v);
  sensors.see(from_s, start);
  const auto see = [&](double t, const Pose& pose) { sensors.see(t, pose); };
  std::vector<double> out;
  std::size_t next = 0;
  for (const Row& row : rows) {
    for (; next < at_s.size() && at_s[next] <= row.time_s; ++next) {
      crane.advance(at_s[next], {}, see);
      const auto [position, swing] = sensors.measured();
      for (const Channel& c : channels) out.push_back(c.swing ? swing[c.number] : position[c.number]);
    }
    crane.advance(row.time_s, {}, see);
    crane.command(row.command_v);
  }
  return out;
}

}  // namespace

Visibility::~Visibility() = default;

Visibility::Visibility(const Physics& nominal, const std::vector<Run>& clean) : nominal_(nominal) {
  nominal_.law = StandstillLaw::dahl;
  nominal_.presliding_m = 2e-5;
  const auto channels = channels_of(nominal.rig);
  for (const Channel& c : channels)
    names_.push_back(c.swing ? (c.number == kRadial ? "swing_radial_rad" : "swing_tangential_rad")
                             : (c.number == kTrolley ? "trolley_position_m" : "slew_angle_rad"));
  std::vector<double> squares(channels.size(), 0);
  std::size_t count = 0;
  const std::size_t each = std::max<std::size_t>(1, kMostWindows / clean.size());
  for (const Run& run : clean) {
    const double span = run.plan.duration_s - kWindow_s - 1;
    for (std::size_t w = 0; w < each; ++w) {
      const double wanted = 1 + span * static_cast<double>(w) / static_cast<double>(each);
      std::size_t first = 0;
      while (first + 2 < run.rows.size() && run.rows[first].time_s < wanted) ++first;
      Window window;
      window.from_s = run.rows[first].time_s;
      window.cable_m = run.plan.cable_m;
      window.start = run.poses[first];
      std::size_t last = first;
      while (last + 1 < run.rows.size() && run.rows[last].time_s < window.from_s + kWindow_s) ++last;
      // The command of the previous row acts at the start, for any delay.
      for (std::size_t i = first > 0 ? first - 1 : 0; i <= last; ++i) window.rows.push_back(run.rows[i]);
      const std::size_t stride = std::max<std::size_t>(1, (last - first) / kMostRows);
      std::vector<double> seen;
      for (std::size_t i = first + 1; i <= last; i += stride) {
        if (run.rows[i].time_s < window.from_s + kLeadIn_s) continue;
        window.at_s.push_back(run.rows[i].time_s);
        for (const Channel& c : channels)
          seen.push_back(c.swing ? run.rows[i].swing[c.number] : run.rows[i].position[c.number]);
      }
      Physics physics = nominal_;
      physics.rig.cable_m = window.cable_m;
      window.base = simulated(physics, window.start, window.from_s, window.rows, window.at_s, channels);
      const auto rows = static_cast<Eigen::Index>(window.base.size());
      std::vector<Eigen::VectorXd> ways;
      const auto vector_of = [&](const std::vector<double>& v) {
        return Eigen::Map<const Eigen::VectorXd>(v.data(), rows);
      };
      for (const Channel& c : channels)
        for (const bool rate : {false, true}) {
          Pose other = window.start;
          (c.swing ? (rate ? other.rate : other.swing)[c.number]
                   : (rate ? other.speed : other.position)[c.number]) += 1e-3;
          ways.push_back(
              vector_of(simulated(physics, other, window.from_s, window.rows, window.at_s, channels)) -
              vector_of(window.base));
        }
      Eigen::MatrixXd all(rows, static_cast<Eigen::Index>(ways.size()));
      for (std::size_t k = 0; k < ways.size(); ++k)
        all.col(static_cast<Eigen::Index>(k)) = ways[k].normalized();
      window.starts = Eigen::HouseholderQR<Eigen::MatrixXd>(all).householderQ() *
                      Eigen::MatrixXd::Identity(rows, static_cast<Eigen::Index>(ways.size()));
      Eigen::VectorXd left = vector_of(seen) - vector_of(window.base);
      left -= window.starts * (window.starts.transpose() * left);
      for (Eigen::Index i = 0; i < rows; ++i)
        squares[static_cast<std::size_t>(i) % channels.size()] += left[i] * left[i];
      count += window.at_s.size();
      windows_.push_back(std::move(window));
    }
  }
  for (const double s : squares)
    nuisance_rms_.push_back(std::sqrt(s / static_cast<double>(std::max<std::size_t>(1, count))));
}

std::vector<double> Visibility::change(const Window& window, const std::vector<Fault>& faults) const {
  Physics physics = nominal_;
  physics.rig.cable_m = window.cable_m;
  const auto with_fault = simulated(with(physics, faults), window.start, window.from_s, window.rows,
                                    window.at_s, channels_of(nominal_.rig));
  const auto rows = static_cast<Eigen::Index>(window.base.size());
  Eigen::VectorXd left = Eigen::Map<const Eigen::VectorXd>(with_fault.data(), rows) -
                         Eigen::Map<const Eigen::VectorXd>(window.base.data(), rows);
  left -= window.starts * (window.starts.transpose() * left);
  return {left.begin(), left.end()};
}

std::vector<Column> Visibility::columns(const std::vector<Fault>& faults) const {
  std::vector<Column> all;
  for (std::size_t c = 0; c < names_.size(); ++c) all.push_back({names_[c], nuisance_rms_[c], 0});
  std::size_t count = 0;
  for (const Window& window : windows_) {
    const auto left = change(window, faults);
    for (std::size_t i = 0; i < left.size(); ++i) all[i % all.size()].effect += left[i] * left[i];
    count += window.at_s.size();
  }
  for (Column& column : all)
    column.effect = std::sqrt(column.effect / static_cast<double>(std::max<std::size_t>(1, count)));
  return all;
}

double Visibility::size(const std::vector<Fault>& faults) const {
  double size = 0;
  for (const Column& column : columns(faults))
    size = std::max(size, column.effect / std::max(1e-12, column.nuisance));
  return size;
}

double Visibility::cosine(const std::vector<Fault>& a, const std::vector<Fault>& b) const {
  double ab = 0, aa = 0, bb = 0;
  for (const Window& window : windows_) {
    const auto x = change(window, a), y = change(window, b);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double weight = 1 / std::max(1e-12, nuisance_rms_[i % names_.size()]);
      ab += x[i] * y[i] * weight * weight, aa += x[i] * x[i] * weight * weight,
          bb += y[i] * y[i] * weight * weight;
    }
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace mujoco_truth
