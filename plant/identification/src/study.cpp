#include "crane/identification/study.hpp"

namespace crane::identification {
namespace {

struct Printed {
  double value;
  Coefficients printed;
  bool chatters = false;
};

/// One table of the source: its axis, its settings and its printed rows.
struct Table {
  const char* name;
  TestProblem problem;
  double zero_band;  ///< d_s of a table that varies omega_c; 0: the table varies d_s, without filter
  std::vector<Printed> rows;
};

TestProblem gain_scheduling_gains() { return {}; }

TestProblem tracking_gains() {
  TestProblem problem;
  problem.proportional_vpm = 100;
  problem.derivative_s = 0.2;
  return problem;
}

TestProblem without_coulomb() {
  TestProblem problem;
  problem.friction.coulomb_positive_v = problem.friction.coulomb_negative_v = 0;
  return problem;
}

std::vector<Table> tables() {
  return {{"3.1",
           gain_scheduling_gains(),
           0,
           {{0, {5.341387, 8.694841, 0.669620, 0.855119}, true},
            {0.005, {3.640265, 6.285023, 0.893631, 1.119057}, true},
            {0.01, {2.899597, 5.625552, 0.991304, 1.189285}},
            {0.05, {2.832908, 5.519729, 1.000881, 1.201942}},
            {0.1, {2.823311, 5.517687, 1.002365, 1.202331}}}},
          {"3.2",
           gain_scheduling_gains(),
           0.05,
           {{0.5, {5.823359, 9.735506, 0.725377, 0.727089}},
            {1, {3.101434, 5.687506, 0.995972, 1.216083}},
            {2, {2.643425, 5.408402, 1.031581, 1.216711}},
            {5, {2.817789, 5.524590, 1.003190, 1.201192}},
            {10, {2.836635, 5.520508, 1.000291, 1.201844}}}},
          {"3.3",
           without_coulomb(),
           0.05,
           {{0.5, {3.281546, 4.786741, -0.052189, 0.090821}},
            {1, {2.545240, 5.607126, 0.062907, -0.01946}},
            {2, {2.715645, 5.537910, 0.025070, -0.003621}},
            {5, {2.819954, 5.524590, 0.000689, 0.000550}},
            {10, {2.819037, 5.517529, 0.001074, 0.000335}}}},
          {"3.4",
           tracking_gains(),
           0,
           {{0, {2.979380, 5.642228, 0.885693, 1.112756}, true},
            {0.01, {2.849118, 5.542317, 0.981689, 1.185655}},
            {0.02, {2.832579, 5.530738, 0.993986, 1.194183}},
            {0.05, {2.823444, 5.521993, 1.000868, 1.200712}}}},
          {"3.5",
           tracking_gains(),
           0.02,
           {{0.5, {4.213892, 5.877469, 0.121192, 0.776435}},
            {1, {3.253598, 6.169105, 0.708620, 0.722327}},
            {5, {2.842247, 5.576426, 0.987037, 1.160845}},
            {10, {2.830800, 5.536750, 0.995481, 1.189793}}}}};
}

Coefficients estimated(const AxisRun& run, const FrictionOptions& options) {
  const FrictionEstimate e = estimate_friction(run, options);
  return {e.viscous_positive.value, e.viscous_negative.value, e.coulomb_positive.value,
          e.coulomb_negative.value};
}

}  // namespace

std::vector<StudyRow> recompute_tables() {
  std::vector<StudyRow> rows;
  for (const Table& table : tables()) {
    const AxisRun continuous = simulate(table.problem);
    TestProblem computer = table.problem;
    computer.held = true;
    AxisRun held = simulate(computer);
    held.speed.clear();
    const bool of_bands = table.zero_band == 0;
    for (const Printed& printed : table.rows) {
      FrictionOptions options;
      options.regression = Regression::dissertation;
      options.zero_band = of_bands ? printed.value : table.zero_band;
      options.cutoff_ratio = of_bands ? 0 : printed.value * table.problem.period_s;
      options.gain = table.problem.gain;
      StudyRow row{table.name,      of_bands ? "d_s" : "omega_c",   printed.value,
                   printed.printed, estimated(continuous, options), {},
                   printed.chatters};
      options.regression = Regression::midpoint;
      row.midpoint = estimated(held, options);
      rows.push_back(row);
    }
  }
  return rows;
}

Coefficients exact(const StudyRow& row) {
  const FrictionCoefficients f = TestProblem{}.friction;
  const bool coulomb = row.table != "3.3";
  return {f.viscous_positive_vspm, f.viscous_negative_vspm, coulomb ? f.coulomb_positive_v : 0,
          coulomb ? f.coulomb_negative_v : 0};
}

}  // namespace crane::identification
