#include "leftover/leftover.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

constexpr int kFlips = 199;
constexpr double kRidge = 0.003;  // of the mean diagonal

/// Columns: hats over a quantity that runs from 0 to 1.
void hats(double q, std::size_t count, double factor, double* h) {
  const double at = std::clamp(q, 0.0, 1.0) * static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i)
    h[i] = factor * std::max(0.0, 1 - std::abs(at - static_cast<double>(i)));
}

struct Group {
  std::string name;
  Columns columns;
  std::size_t coordinate = 0;
};

class Groups {
 public:
  Groups(const Problem& problem, const Hypothesis& at)
      : scales_(problem.scales), layout_(problem.layout(at.values)) {
    for (const Run& run : problem.runs) longest_s_ = std::max(longest_s_, run.end_s() - run.begin_s());
    begin_s_ = problem.runs.front().begin_s();
    for (std::size_t i = 0; i < 2; ++i)
      if (layout_.volts[i]) add_drive(i);
    for (std::size_t k = 0; k < 2; ++k)
      if (layout_.has(k == 0 ? kPhi : kTheta)) add_swing(k);
  }
  std::vector<Group> all;

 private:
  template <class Quantity, class Factor>
  void add(const std::string& name, std::size_t coordinate, std::size_t count, Quantity quantity,
           Factor factor) {
    Group g{name, {std::vector<std::size_t>(count, coordinate), {}}, coordinate};
    g.columns.evaluate = [=](double t, const double* s, const std::array<double, 2>& u, double* h) {
      hats(quantity(t, s), count, factor(s, u), h);
    };
    all.push_back(std::move(g));
  }

  void add_drive(std::size_t i) {
    const std::size_t coordinate = i == 0 ? kX : kGamma, b = layout_.begin[coordinate];
    const std::string drive = std::string{kDriveNames[i]} + " force by ";
    const double low = scales_.middle[i] - 0.5 * scales_.travel[i], width = scales_.travel[i],
                 speed = scales_.speed[i];
    const double rest = rule::kRestBand.value * rule::kRestSpeed.value * speed;
    const auto one = [](const double*, const std::array<double, 2>&) { return 1.0; };
    const auto place = [=](double, const double* s) { return (s[b] - low) / width; };
    const auto time = [begin = begin_s_, length = longest_s_](double t, const double*) {
      return (t - begin) / length;
    };
    const auto sign = [=](const double* s, const std::array<double, 2>&) {
      return std::tanh(s[b + 1] / rest);
    };
    add(drive + "position", coordinate, 24, place, one);
    add(
        drive + "speed", coordinate, 13,
        [=](double, const double* s) { return 0.5 + 0.5 * s[b + 1] / speed; }, one);
    add(drive + "direction and position", coordinate, 16, place, sign);
    add(drive + "command over time", coordinate, 8, time,
        [i](const double*, const std::array<double, 2>& u) { return u[i]; });
  }

  void add_swing(std::size_t k) {
    const std::size_t coordinate = k == 0 ? kPhi : kTheta, b = layout_.begin[coordinate];
    const std::string name = std::string{kSwingNames[k]} + " force by ";
    const double angle = scales_.swing_rad, rate = angle * scales_.omega_radps;
    const auto one = [](const double*, const std::array<double, 2>&) { return 1.0; };
    add(
        name + "swing", coordinate, 9, [=](double, const double* s) { return 0.5 + 0.5 * s[b] / angle; },
        one);
    add(
        name + "swing rate", coordinate, 9,
        [=](double, const double* s) { return 0.5 + 0.5 * s[b + 1] / rate; }, one);
    const std::size_t drive = layout_.begin[k == 0 ? kX : kGamma];
    if (drive == kNone) return;
    const double speed = scales_.speed[k], low = scales_.middle[k] - 0.5 * scales_.travel[k],
                 width = scales_.travel[k];
    add(
        name + "drive position", coordinate, 12,
        [=](double, const double* s) { return (s[drive] - low) / width; }, one);
    add(
        name + "drive speed", coordinate, 9,
        [=](double, const double* s) { return 0.5 + 0.5 * s[drive + 1] / speed; }, one);
  }

  const Scales& scales_;
  Layout layout_;
  double longest_s_ = 1, begin_s_ = 0;
};

/// Normal equations of every block.
struct Normal {
  std::vector<Eigen::MatrixXd> gram;
  std::vector<Eigen::VectorXd> right;
};

Normal normal_of(const Whitened& w, const Blocks& blocks) {
  const Eigen::Index n = w.x.cols();
  Normal normal{std::vector<Eigen::MatrixXd>(blocks.count, Eigen::MatrixXd::Zero(n, n)),
                std::vector<Eigen::VectorXd>(blocks.count, Eigen::VectorXd::Zero(n))};
  for (Eigen::Index k = 0; k < w.x.rows(); ++k) {
    const std::size_t b = blocks.of_value[static_cast<std::size_t>(k)];
    if (w.y[k] == 0) continue;
    normal.gram[b].noalias() += w.x.row(k).transpose() * w.x.row(k);
    normal.right[b].noalias() += w.y[k] * w.x.row(k).transpose();
  }
  return normal;
}

/// Cross-validated gain of a ridge over folds of blocks; `sign` per block.
class Ridge {
 public:
  explicit Ridge(const Normal& normal) : normal_(normal) {
    const Eigen::Index n = normal.gram.front().rows();
    const auto folds = static_cast<std::size_t>(rule::kFolds.value);
    gram_.assign(folds, Eigen::MatrixXd::Zero(n, n));
    for (std::size_t b = 0; b < normal.gram.size(); ++b) gram_[fold(b)] += normal.gram[b];
    all_ = Eigen::MatrixXd::Zero(n, n);
    for (const auto& g : gram_) all_ += g;
    ridge_ = kRidge * all_.trace() / static_cast<double>(n) + 1e-9;
    for (const auto& g : gram_) {
      Eigen::MatrixXd others = all_ - g;
      others.diagonal().array() += ridge_;
      solvers_.emplace_back(others);
    }
  }
  [[nodiscard]] double gain(const std::vector<double>& sign) const {
    const Eigen::Index n = all_.rows();
    std::vector<Eigen::VectorXd> right(gram_.size(), Eigen::VectorXd::Zero(n));
    for (std::size_t b = 0; b < normal_.right.size(); ++b) right[fold(b)] += sign[b] * normal_.right[b];
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    for (const auto& r : right) sum += r;
    double gain = 0;
    for (std::size_t f = 0; f < gram_.size(); ++f) {
      const Eigen::VectorXd amount = solvers_[f].solve(sum - right[f]);
      gain += amount.dot(right[f]) - 0.5 * amount.dot(gram_[f] * amount);
    }
    return gain;
  }
  [[nodiscard]] Eigen::VectorXd amounts() const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(all_.rows());
    for (const auto& r : normal_.right) sum += r;
    Eigen::MatrixXd a = all_;
    a.diagonal().array() += ridge_;
    return a.ldlt().solve(sum);
  }

 private:
  [[nodiscard]] std::size_t fold(std::size_t block) const { return (block / 2) % gram_.size(); }
  const Normal& normal_;
  std::vector<Eigen::MatrixXd> gram_;
  Eigen::MatrixXd all_;
  double ridge_ = 0;
  std::vector<Eigen::LDLT<Eigen::MatrixXd>> solvers_;
};

/// rms of the fitted force along the filtered motion.
double force_rms(const Problem& problem, const Hypothesis& at, const Group& g,
                 const Eigen::VectorXd& amounts) {
  double squares = 0, count = 0;
  std::vector<double> h(g.columns.coordinate.size());
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Innovations run = innovations(problem, at, r, nullptr, true);
    for (std::size_t k = 0; k < run.time_s.size(); k += 5) {
      const auto state = run.states.col(static_cast<Eigen::Index>(k));
      if (state.isZero()) continue;
      const std::array<double, 2> volts{1, 1};
      g.columns.evaluate(run.time_s[k], state.data(), volts, h.data());
      double force = 0;
      for (std::size_t j = 0; j < h.size(); ++j) force += h[j] * amounts[static_cast<Eigen::Index>(j)];
      squares += force * force, count += 1;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace

Leftover leftover(const Problem& problem, const Hypothesis& at, std::uint64_t seed) {
  std::vector<Group> groups = Groups{problem, at}.all;
  Leftover result;
  if (groups.empty()) return result;
  const Blocks blocks = blocks_of(problem);
  std::vector<std::vector<double>> flipped(groups.size());
  result.groups.resize(groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t i) {
    const Normal normal = normal_of(whitened(problem, at, groups[i].columns), blocks);
    const Ridge ridge{normal};
    LeftoverGroup& g = result.groups[i];
    g.name = groups[i].name;
    g.gain = ridge.gain(std::vector<double>(blocks.count, 1));
    g.force_rms = force_rms(problem, at, groups[i], ridge.amounts());
    const double unknown = std::exp(at.values[of_noise(kChannelOf[groups[i].coordinate], kLogForce)]);
    g.share = g.force_rms * g.force_rms / (g.force_rms * g.force_rms + unknown * unknown);
    std::mt19937_64 random{seed};
    for (int f = 0; f < kFlips; ++f) {
      std::vector<double> sign(blocks.count);
      for (double& s : sign) s = (random() & 1) != 0 ? 1 : -1;
      flipped[i].push_back(ridge.gain(sign));
    }
  });
  double largest = -1e300;
  for (const LeftoverGroup& g : result.groups) largest = std::max(largest, g.gain);
  int more = 0;
  for (int f = 0; f < kFlips; ++f) {
    double most = -1e300;
    for (const auto& gains : flipped) most = std::max(most, gains[static_cast<std::size_t>(f)]);
    more += most >= largest;
  }
  result.p_value = (more + 1.0) / (kFlips + 1.0);
  std::stable_sort(result.groups.begin(), result.groups.end(),
                   [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return result;
}

}  // namespace crane::innovations
