#pragma once
/// The filter for a state of N numbers.
#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "crane/innovations/rules.hpp"
#include "filter/command.hpp"
#include "filter/kalman_filter.hpp"

namespace crane::innovations {

/// Exact local linearisation s+ = s + G f, P+ = F P F', F = exp(A h), G = int exp(A u) du (Jimenez, Ozaki
/// 2003): Taylor to order three with scaling and doubling, G <- G + F G, F <- F F, so that stiff dry friction
/// is exact.
template <int N>
void linearised_step(const Eigen::Matrix<double, N, N>& a, double h, Eigen::Matrix<double, N, N>& f,
                     Eigen::Matrix<double, N, N>& g) {
  using Square = Eigen::Matrix<double, N, N>;
  int doublings = 0;
  const double size = a.diagonal().cwiseAbs().maxCoeff() * h;
  while (doublings < 12 && size / (1 << doublings) > 0.25) ++doublings;
  const double step = h / (1 << doublings);
  const Square ah = a * step, a2 = ah * ah, a3 = a2 * ah;
  f = Square::Identity() + ah + 0.5 * a2 + a3 / 6;
  g = step * (Square::Identity() + 0.5 * ah + a2 / 6 + a3 / 24);
  for (int i = 0; i < doublings; ++i) {
    g = (g + f * g).eval();
    f = (f * f).eval();
  }
}

template <int N>
class FilterOfSize {
 public:
  using State = Eigen::Matrix<double, N, 1>;
  using Square = Eigen::Matrix<double, N, N>;
  using Row = Eigen::Matrix<double, 1, N>;

  FilterOfSize(CraneModel model, const Nominal& nominal, const Scales& scales, const Run& run,
               const Values& values, const FilterRequest& request)
      : model_(std::move(model)),
        layout_(model_.layout),
        scales_(scales),
        run_(run),
        p_(values),
        request_(request),
        commands_{Command{run.command[0], values, 0, request.between},
                  Command{run.command[1], values, 1, request.between}} {
    longest_s_ = std::min(rule::kStepMost.value,
                          rule::kStep.value / std::sqrt(nominal.plant.gravity_mps2 / nominal.cable_m));
    if (!layout_.has(kPhi) && !layout_.has(kTheta)) longest_s_ = rule::kStepMost.value;
    std::size_t count = 0;
    for (std::size_t c = 0; c < kChannels; ++c) first_[c] = count, count += run.measured[c].size();
    out_.e.assign(count, 0), out_.variance.assign(count, 1), out_.log_likelihood.assign(count, 0);
    out_.time_s.assign(count, 0), out_.channel.assign(count, 0);
    for (std::size_t c = 0; c < kChannels; ++c)
      for (std::size_t k = 0; k < run.measured[c].size(); ++k) {
        out_.time_s[first_[c] + k] = run.measured[c].time_s[k];
        out_.channel[first_[c] + k] = static_cast<unsigned char>(c);
      }
    if (request.keep_states) out_.states = Eigen::MatrixXd::Zero(N, static_cast<Eigen::Index>(count));
    if (request.columns != nullptr) {
      const auto columns = static_cast<Eigen::Index>(request.columns->coordinate.size());
      delta_ = Eigen::MatrixXd::Zero(N, columns);
      h_.resize(request.columns->coordinate.size());
      out_.sensitivity = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), columns);
    }
    begin();
  }

  Innovations finished() {
    for (;;) {
      const auto [what, at_s] = next_event();
      if (what == kNone) break;
      propagate(at_s);
      if (!out_.finite) break;
      if (what < 2) {
        const double area = commands_[what].pass();
        if (request_.open_loop == nullptr) add_command_noise(what, area);
      } else {
        measure(what - 2);
      }
    }
    return std::move(out_);
  }

 private:
  struct Event {
    std::size_t what;  ///< 0, 1: command; 2 + channel
    double at_s;
  };

  [[nodiscard]] double late_s(std::size_t channel) const {
    return channel < 2 ? 0 : p_[of_load(kSwingDelay)] + 0.5 * p_[of_load(kSwingAverage)];
  }

  Event next_event() {
    Event next{kNone, 1e300};
    bool measurements_left = false;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const Series& s = run_.measured[c];
      while (at_[c] < s.size() && s.time_s[at_[c]] - late_s(c) < now_s_ - 1e-9) ++at_[c];  // before the start
      if (at_[c] >= s.size() || !layout_.has(kCoordinateOf[c])) continue;
      measurements_left = true;
      if (const double t = s.time_s[at_[c]] - late_s(c); t < next.at_s) next = {2 + c, t};
    }
    if (!measurements_left) return {kNone, 0};
    for (std::size_t i = 0; i < 2; ++i)
      if (layout_.volts[i] && commands_[i].next_s() <= next.at_s) next = {i, commands_[i].next_s()};
    return next;
  }

  void begin() {
    now_s_ = run_.begin_s();
    for (std::size_t c = 0; c < kChannels; ++c) {
      const std::size_t b = layout_.begin[kCoordinateOf[c]];
      if (b == kNone) continue;
      const auto at = static_cast<Eigen::Index>(b);
      const double force = std::exp(p_[of_noise(c, kLogForce)]);
      const double scale = c < 2 ? scales_.travel[c] : scales_.swing_rad;
      const double speed = c < 2 ? scales_.speed[c] : scales_.swing_rad * scales_.omega_radps;
      covariance_(at, at) = 0.01 * scale * scale, covariance_(at + 1, at + 1) = speed * speed;
      covariance_(at + 2, at + 2) = force * force;
      if (run_.measured[c].empty()) continue;
      s_[at] = (run_.measured[c].value[0] - offset(c)) / factor(c);
      covariance_(at, at) = 4 * sensor_variance(p_, scales_, run_, c);
    }
    for (std::size_t k = 0; k < 2; ++k)
      if (const std::size_t b = layout_.lower[k]; b != kNone) {
        const auto at = static_cast<Eigen::Index>(b);
        const std::size_t upper = layout_.begin[k == 0 ? kPhi : kTheta];
        s_[at] = s_[static_cast<Eigen::Index>(upper)] + request_.start.lower_rad[k];
        s_[at + 1] = request_.start.lower_radps[k];
        covariance_(at, at) = std::pow(0.1 * scales_.swing_rad, 2);
        covariance_(at + 1, at + 1) = std::pow(0.2 * scales_.swing_rad * scales_.omega_radps, 2);
      }
    if (request_.open_loop != nullptr) begin_open_loop();
    while (layout_.volts[0] && commands_[0].next_s() <= now_s_) commands_[0].pass();
    while (layout_.volts[1] && commands_[1].next_s() <= now_s_) commands_[1].pass();
    follow_cable();
  }

  /// Nothing is uncertain but the motion of a drive whose command is not known: that is followed as measured.
  void begin_open_loop() {
    const Square all = covariance_;
    s_ = *request_.open_loop;
    covariance_.setZero();
    for (std::size_t c = 0; c < 2; ++c)
      if (follows(c)) {
        const auto b = static_cast<Eigen::Index>(layout_.begin[kCoordinateOf[c]]);
        covariance_.diagonal().segment(b, 3) = all.diagonal().segment(b, 3);
      }
  }
  /// Whether a channel corrects the state.
  [[nodiscard]] bool follows(std::size_t c) const {
    return request_.open_loop == nullptr || (c < 2 && layout_.has(kCoordinateOf[c]) && !layout_.volts[c]);
  }

  [[nodiscard]] double offset(std::size_t c) const { return c < 2 ? 0 : p_[of_load(kSwingOffset + c - 2)]; }
  [[nodiscard]] double factor(std::size_t c) const {
    return 1 + (c < 2 ? p_[of_axis(c, kPositionScale)] : p_[of_load(kSwingScale + c - 2)]);
  }

  /// The measured length, straight between its rows, its speed over a tenth of a second.
  void follow_cable() {
    const Series& cable = run_.cable;
    if (cable.empty()) return;
    while (cable_at_ + 1 < cable.size() && cable.time_s[cable_at_ + 1] <= now_s_) ++cable_at_;
    std::size_t from = cable_at_, to = cable_at_;
    while (from > 0 && now_s_ - cable.time_s[from] < 0.05) --from;
    while (to + 1 < cable.size() && cable.time_s[to] - now_s_ < 0.05) ++to;
    const double width = cable.time_s[to] - cable.time_s[from];
    const double speed = width > 0 ? (cable.value[to] - cable.value[from]) / width : 0;
    model_.set_cable(cable.value[cable_at_] + speed * (now_s_ - cable.time_s[cable_at_]), speed);
  }

  [[nodiscard]] std::array<double, 2> softness() const {
    std::array<double, 2> soft{1, 1};
    for (std::size_t i = 0; i < 2; ++i)
      if (const std::size_t b = layout_.begin[i == 0 ? kX : kGamma]; b != kNone) {
        const auto at = static_cast<Eigen::Index>(b) + 1;
        const double rest = rule::kRestSpeed.value * scales_.speed[i];
        soft[i] = std::sqrt(rest * rest + std::max(0.0, covariance_(at, at)));
      }
    return soft;
  }

  /// Not past a turn of a drive, and shorter near its rest.
  [[nodiscard]] double step_towards(double to, const State& f, const std::array<double, 2>& soft) const {
    double h = std::min(to - now_s_, longest_s_);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!layout_.volts[i]) continue;
      const std::size_t b = layout_.begin[i == 0 ? kX : kGamma];
      const double v = s_[static_cast<Eigen::Index>(b) + 1], a = f[static_cast<Eigen::Index>(b) + 1];
      if (v * (v + a * h) < 0 && std::abs(v) > 2 * rule::kRestSpeed.value * scales_.speed[i])
        h = std::min(h, std::max(5e-4, std::abs(v / a)));
      if (std::abs(v) < 6 * soft[i]) h = std::min(h, rule::kRestStep.value);
    }
    return h;
  }

  [[nodiscard]] State rate(const State& s, const std::array<double, 2>& volts,
                           const std::array<double, 2>& soft) const {
    State r = State::Zero();
    model_.rate(s.data(), volts, soft, r.data());
    return r;
  }

  [[nodiscard]] Square jacobian(const State& f, const std::array<double, 2>& volts,
                                const std::array<double, 2>& soft) const {
    Square a;
    State s = s_;
    for (Eigen::Index j = 0; j < N; ++j) {
      double step = 1e-5;
      if (j == speed_index(0)) step = 0.05 * soft[0];
      if (j == speed_index(1)) step = 0.05 * soft[1];
      s[j] += step;
      a.col(j) = (rate(s, volts, soft) - f) / step;
      s[j] = s_[j];
    }
    return a;
  }
  [[nodiscard]] Eigen::Index speed_index(std::size_t i) const {
    const std::size_t b = layout_.begin[i == 0 ? kX : kGamma];
    return layout_.volts[i] ? static_cast<Eigen::Index>(b) + 1 : -1;
  }

  void propagate(double to) {
    std::array<double, 2> volts{commands_[0].now(), commands_[1].now()};
    while (to - now_s_ > 1e-9) {
      const auto soft = softness();
      const double h = step_towards(to, rate(s_, volts, soft), soft);
      for (std::size_t i = 0; i < 2; ++i) volts[i] = commands_[i].mean(now_s_, h);
      const State f = rate(s_, volts, soft);
      const Square a = jacobian(f, volts, soft);
      Square transition, integral;
      linearised_step<N>(a, h, transition, integral);
      if (request_.columns != nullptr) push_columns(volts, a, transition, integral);
      s_ += integral * f;
      if (request_.open_loop == nullptr || follows(0) || follows(1)) {
        add_unknown_force(h / 6, Square::Zero());
        covariance_ = (transition * covariance_ * transition.transpose()).eval();
        add_unknown_force(h / 6, Square::Zero());
        add_unknown_force(2 * h / 3, 0.5 * h * a);
        last_volts_column_ = a;
      }
      if (request_.open_loop == nullptr) add_standstill(h);
      now_s_ += h;
      follow_cable();
      if (!s_.allFinite() || s_.cwiseAbs().maxCoeff() > 1e9) {
        out_.finite = false;
        return;
      }
    }
  }

  void push_columns(const std::array<double, 2>& volts, const Square& a, const Square& transition,
                    const Square& integral) {
    request_.columns->evaluate(now_s_, s_.data(), volts, h_.data());
    delta_ = (transition * delta_).eval();
    for (std::size_t j = 0; j < h_.size(); ++j) {
      if (h_[j] == 0) continue;
      const auto d = static_cast<Eigen::Index>(layout_.begin[request_.columns->coordinate[j]]) + 2;
      State push = a.col(d);
      push[d] = 0;
      delta_.col(static_cast<Eigen::Index>(j)) += integral * push * h_[j];
    }
  }

  /// d' = -d/T + sqrt(2 sigma^2 / T) w, its covariance by Simpson's rule: what enters at the begin, in the
  /// middle and at the end of a step.
  /// @param later A times the time that is left of the step
  void add_unknown_force(double seconds, const Square& later) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      const std::size_t b = layout_.begin[kCoordinateOf[c]];
      if (b == kNone || !follows(c)) continue;
      const auto d = static_cast<Eigen::Index>(b) + 2;
      State entered = later.col(d);
      entered[d] += 1;
      const double intensity =
          2 * std::exp(2 * p_[of_noise(c, kLogForce)] - p_[of_noise(c, kLogCorrelation)]);
      covariance_ += intensity * seconds * entered * entered.transpose();
    }
  }

  /// White acceleration near rest, where friction has a memory that the law lacks: q^2 exp(-v^2/(v_b^2 +
  /// P_vv)).
  void add_standstill(double h) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!layout_.volts[i]) continue;
      const auto v = speed_index(i), x = v - 1;
      const double band = rule::kRestBand.value * rule::kRestSpeed.value * scales_.speed[i];
      const double wide = band * band + std::max(0.0, covariance_(v, v));
      const double q = std::exp(2 * p_[standstill_of(i)] - s_[v] * s_[v] / wide);
      covariance_(v, v) += q * h, covariance_(x, x) += q * h * h * h / 3;
      covariance_(v, x) += q * h * h / 2, covariance_(x, v) = covariance_(v, x);
    }
  }

  /// When between its rows a command changed is not known: an impulse in proportion to the change.
  void add_command_noise(std::size_t i, double area) {
    if (area <= 0) return;
    const auto d = static_cast<Eigen::Index>(layout_.begin[i == 0 ? kX : kGamma]) + 2;
    State push = last_volts_column_.col(d);
    push[d] = 0;
    const double share = std::exp(p_[command_noise_of(i)]) * area;
    covariance_ += share * share * push * push.transpose();
  }

  void measure(std::size_t c) {
    const std::size_t k = at_[c]++;
    const auto q = static_cast<Eigen::Index>(layout_.begin[kCoordinateOf[c]]);
    Row h = Row::Zero();
    double y = 0;
    if (c < 2) {
      h[q] = factor(c), y = h[q] * s_[q];
    } else {
      y = swing_seen(c - 2, h);
    }
    update(first_[c] + k, run_.measured[c].value[k] - y, h, sensor_variance(p_, scales_, run_, c));
  }

  /// phi + w^2/24 phi'' at t - delay - w/2 is the moving average to fourth order; misalignment turns the
  /// pair.
  double swing_seen(std::size_t k, Row& h) {
    const double turn = p_[of_load(kMisalignment)];
    const auto own = layout_.begin[k == 0 ? kPhi : kTheta], other = layout_.begin[k == 0 ? kTheta : kPhi];
    const auto q = static_cast<Eigen::Index>(own);
    h[q] = 1;
    double y = s_[q];
    if (const double w = p_[of_load(kSwingAverage)]; w > 0) {
      const std::array<double, 2> volts{commands_[0].now(), commands_[1].now()};
      const auto soft = softness();
      const double bend = w * w / 24;
      const State f = rate(s_, volts, soft);
      y += bend * f[q + 1];
      h += bend * jacobian(f, volts, soft).row(q + 1);
    }
    if (turn != 0 && other != kNone) {
      const auto o = static_cast<Eigen::Index>(other);
      const double c = std::cos(turn), n = k == 0 ? std::sin(turn) : -std::sin(turn);
      y = c * y + n * s_[o];
      h *= c, h[o] += n;
    }
    const double gain = 1 + p_[of_load(kSwingScale + k)];
    h *= gain;
    return gain * y + p_[of_load(kSwingOffset + k)];
  }

  void update(std::size_t slot, double e, const Row& h, double noise) {
    if (!follows(out_.channel[slot])) {
      out_.e[slot] = e, out_.variance[slot] = noise;
      return;
    }
    const State ph = covariance_ * h.transpose();
    const double variance = h * ph + noise;
    if (!(variance > 0) || !std::isfinite(e)) {
      out_.finite = false;
      return;
    }
    out_.e[slot] = e, out_.variance[slot] = variance;
    if (run_.measured[out_.channel[slot]].time_s[slot - first_[out_.channel[slot]]] >
        run_.begin_s() + rule::kBurnIn.value)
      out_.log_likelihood[slot] = student_log_density(e, variance);
    const State gain = ph / variance;
    if (request_.columns != nullptr) {
      const Eigen::RowVectorXd row = h * delta_;
      out_.sensitivity.row(static_cast<Eigen::Index>(slot)) = row / std::sqrt(variance);
      delta_ -= gain * row;
    }
    s_ += gain * e;
    covariance_ -= gain * ph.transpose();
    covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
    if (request_.keep_states) out_.states.col(static_cast<Eigen::Index>(slot)) = s_;
  }

  CraneModel model_;
  const Layout& layout_;
  const Scales& scales_;
  const Run& run_;
  const Values& p_;
  const FilterRequest& request_;
  std::array<Command, 2> commands_;
  std::array<std::size_t, kChannels> first_{}, at_{};
  std::size_t cable_at_ = 0;
  double now_s_ = 0, longest_s_ = 0.01;
  State s_ = State::Zero();
  Square covariance_ = Square::Zero(), last_volts_column_ = Square::Zero();
  Eigen::MatrixXd delta_;
  std::vector<double> h_;
  Innovations out_;
};

}  // namespace crane::innovations
