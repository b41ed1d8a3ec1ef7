/// The filter against the joint Gaussian density, and its derivatives against finite differences.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "candidates/screen.hpp"
#include "rigs.hpp"

namespace crane::innovations::test {
namespace {

SampleCrane smooth_axis() {
  SampleCrane c;
  c.coulomb_v = 0;
  return c;
}

/// Without dry friction, standstill and command noise a drive axis is linear.
Values linear_values(const Problem& problem) {
  Values v = problem.base;
  v[standstill_of(0)] = -40;
  v[command_noise_of(0)] = -40;
  v[of_noise(0, kLogForce)] = std::log(0.2);
  v[of_noise(0, kLogCorrelation)] = std::log(0.4);
  v[of_noise(0, kLogSensor)] = std::log(1e-4);
  return v;
}

/// x' = v, v' = K (V + d - b v), d' = -d / T: log density of all measured positions at once.
double joint_log_density(const Problem& problem, const Values& values, const Run& run, const SampleCrane& c) {
  const Series& y = run.measured[0];
  const auto n = static_cast<Eigen::Index>(y.size());
  const double sigma2 = std::exp(2 * values[of_noise(0, kLogForce)]),
               correlation = std::exp(values[of_noise(0, kLogCorrelation)]);
  const double noise = sensor_variance(values, problem.scales, run, 0);
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();  // the fourth state is the held command
  a(0, 1) = 1, a(1, 1) = -c.gain * c.viscous_vs, a(1, 2) = c.gain, a(1, 3) = c.gain,
       a(2, 2) = -1 / correlation;
  Eigen::Vector4d mean{y.value[0], 0, 0, run.command[0].value[0]};
  Eigen::Matrix4d p =
      Eigen::Vector4d{4 * noise, problem.scales.speed[0] * problem.scales.speed[0], sigma2, 0}.asDiagonal();
  std::vector<Eigen::Matrix4d> transitions, covariances;
  Eigen::VectorXd means(n);
  double now = y.time_s[0];
  std::size_t command = 0;
  while (command + 1 < run.command[0].size() && run.command[0].time_s[command + 1] <= now) ++command;
  mean[3] = run.command[0].value[command];
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Matrix4d whole = Eigen::Matrix4d::Identity();
    const double to = y.time_s[static_cast<std::size_t>(k)];
    while (now < to) {
      const auto next = command + 1;
      const double edge = next < run.command[0].size() ? run.command[0].time_s[next] : 1e9,
                   until = std::min(edge, to);
      const double h = until - now;
      Eigen::Matrix<double, 8, 8> van_loan = Eigen::Matrix<double, 8, 8>::Zero();
      van_loan.topLeftCorner<4, 4>() = -a, van_loan.bottomRightCorner<4, 4>() = a.transpose();
      van_loan(2, 6) = 2 * sigma2 / correlation;
      const Eigen::Matrix<double, 8, 8> e = (van_loan * h).exp();
      const Eigen::Matrix4d f = e.bottomRightCorner<4, 4>().transpose(), q = f * e.topRightCorner<4, 4>();
      mean = f * mean, p = f * p * f.transpose() + q, whole = f * whole;
      now = until;
      if (until == edge) mean[3] = run.command[0].value[++command];
    }
    means[k] = mean[0];
    transitions.push_back(whole), covariances.push_back(p);
  }
  Eigen::MatrixXd joint(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Matrix4d carried = covariances[static_cast<std::size_t>(i)];
    for (Eigen::Index j = i; j < n; ++j) {
      if (j > i) carried = transitions[static_cast<std::size_t>(j)] * carried;
      joint(i, j) = joint(j, i) = carried(0, 0) + (i == j ? noise : 0);
    }
  }
  const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(y.value.data(), n) - means;
  const Eigen::LLT<Eigen::MatrixXd> llt{joint};
  const Eigen::MatrixXd l = llt.matrixL();
  return -0.5 * e.dot(llt.solve(e)) - l.diagonal().array().log().sum() -
         0.5 * static_cast<double>(n) * std::log(6.283185307179586);
}

TEST(Filter, HasTheLikelihoodOfTheJointGaussianWhereTheCraneIsLinear) {
  const SampleCrane crane = smooth_axis();
  const auto whole = run_of(SampleRun{crane, 3}.rows(3), false);
  std::mt19937 random{5};
  auto run = thinned(whole, [&](double) { return random() % 4 == 0; });  // irregular, with gaps
  for (double& t : run.measured[0].time_s) t += 0.003 * std::uniform_real_distribution<double>{}(random);
  const Problem problem{rig_of(crane), {run}};
  const Values values = linear_values(problem);
  const Innovations out = innovations(problem, {values, {}}, 0);
  double log_density = 0;
  for (std::size_t k = 0; k < out.e.size(); ++k)
    log_density -=
        0.5 * (out.e[k] * out.e[k] / out.variance[k] + std::log(6.283185307179586 * out.variance[k]));
  // The noise of d enters by Simpson's rule along steps of at most 12.5 ms.
  EXPECT_NEAR(log_density, joint_log_density(problem, values, run, crane),
              1e-3 * static_cast<double>(out.e.size()));
}

TEST(DryFriction, CancelsWhatIsAppliedAtRestAndIsTheLevelAtSpeed) {
  SampleCrane crane;
  const Problem problem{rig_of(crane), {run_of(SampleRun{crane, 1}.rows(2), false)}};
  const CraneModel model{problem.nominal, problem.layout(problem.base), problem.base, problem.scales};
  const double soft = 1e-3, c = crane.coulomb_v;
  for (const double applied : {-0.7, -0.2, 0.0, 0.5, 0.79})
    EXPECT_NEAR(model.dry_friction_v(0, 0, 0, applied, 0, soft), applied, 1e-12)
        << "it sticks at " << applied << " V";
  for (const double applied : {-3.0, -0.9, 0.9, 3.0})
    EXPECT_NEAR(model.dry_friction_v(0, 0, 0, applied, 0, soft), std::copysign(c, applied), 1e-12)
        << "it breaks loose";
  for (const double v : {-0.5, -0.05, 0.05, 0.5})
    EXPECT_NEAR(model.dry_friction_v(0, 0, v, -std::copysign(0.5, v), 0, soft), std::copysign(c, v), 1e-12);
}

TEST(DryFriction, IsNeverStrongerThanItsLevelWhateverPushes) {
  SampleCrane crane;
  Problem problem{rig_of(crane), {run_of(SampleRun{crane, 1}.rows(2), false)}};
  problem.base[of_axis(0, kAsymmetryDry)] = 0.1;
  const CraneModel model{problem.nominal, problem.layout(problem.base), problem.base, problem.scales};
  std::mt19937 random{9};
  std::normal_distribution<double> n;
  for (int i = 0; i < 2000; ++i) {
    const double f = model.dry_friction_v(0, 0, 0.1 * n(random), 3 * n(random), 0, 1e-3);
    EXPECT_LE(f, crane.coulomb_v + 0.1 + 1e-12) << "seed 9";
    EXPECT_GE(f, -(crane.coulomb_v - 0.1) - 1e-12) << "seed 9";
  }
}

TEST(Sensitivity, OfAForceColumnIsTheFiniteDifferenceOfTheInnovations) {
  const SampleCrane crane = smooth_axis();
  const Problem problem{rig_of(crane), {run_of(SampleRun{crane, 2}.rows(4), false)}};
  const Values values = linear_values(problem);
  Columns one{{kX}, [](double, const double*, const std::array<double, 2>&, double* h) { h[0] = 1; }};
  const Innovations with = innovations(problem, {values, {}}, 0, &one);
  Values more = values, less = values;
  more[of_axis(0, kOffset)] += 1e-3, less[of_axis(0, kOffset)] -= 1e-3;
  const Innovations up = innovations(problem, {more, {}}, 0), down = innovations(problem, {less, {}}, 0);
  for (std::size_t k = 5; k < with.e.size(); ++k) {
    const double slope = (up.e[k] - down.e[k]) / 2e-3 / std::sqrt(with.variance[k]);
    EXPECT_NEAR(with.sensitivity(static_cast<Eigen::Index>(k), 0), -slope, 1e-3 * (1 + std::abs(slope))) << k;
  }
}

TEST(Scores, AreTheSlopesOfTheLikelihood) {
  SampleCrane crane;
  crane.load_kg = 2;
  const Problem problem{rig_of(crane), {run_of(SampleRun{crane, 4}.rows(8), true)}};
  const Hypothesis at{problem.base, {}};
  const auto l0 = log_likelihoods(problem, at);
  const std::vector<Index> free{of_axis(0, kGain), of_load(kCable), of_noise(2, kLogForce),
                                of_noise(0, kLogSensor)};
  const Eigen::VectorXd slopes = scores(problem, at, free, l0).colwise().sum();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double step = 0.02 * problem.table[free[i]].scale;
    Hypothesis up = at, down = at;
    up.values[free[i]] += step, down.values[free[i]] -= step;
    const double central =
        (sum(log_likelihoods(problem, up)) - sum(log_likelihoods(problem, down))) / (2 * step);
    EXPECT_NEAR(slopes[static_cast<Eigen::Index>(i)], central,
                0.15 * std::abs(central) + 3 / problem.table[free[i]].scale)
        << free[i];
  }
}

}  // namespace
}  // namespace crane::innovations::test
