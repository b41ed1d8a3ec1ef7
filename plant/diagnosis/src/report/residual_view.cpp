#include "report/residual_view.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "crane/diagnosis/replay.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kViewWindow_s = 2.0;
constexpr double kMilli = 1000;

bool is_swing(const std::string& column) {
  return column == kOutputNames[kRadialSwing] || column == kOutputNames[kTangentialSwing];
}

/// Free motions of a wrong start: position and speed of a drive, cosine and sine of a swing.
Eigen::MatrixXd free_motions(bool swing, double swing_radps, Eigen::Index rows, double period_s) {
  Eigen::MatrixXd motions(rows, 2);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) * period_s;
    motions(k, 0) = swing ? std::cos(swing_radps * t) : 1;
    motions(k, 1) = swing ? std::sin(swing_radps * t) : t;
  }
  return motions;
}

std::vector<double> without_start(const Trace& trace, const std::vector<double>& simulated, const Run& run,
                                  const configuration::Rig& rig) {
  const std::size_t rows = trace.measured.size();
  std::vector<double> left(rows);
  for (std::size_t k = 0; k < rows; ++k) left[k] = kMilli * (trace.measured[k] - simulated[k]);
  const auto count = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(static_cast<double>(rows) * run.period_s / kViewWindow_s)));
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t first = w * rows / count, last = (w + 1) * rows / count;
    const auto size = static_cast<Eigen::Index>(last - first);
    if (size < 3) continue;
    const double swing_radps = plant::swing_radps(rig.plant.gravity_mps2, run.cable_m[first]);
    const auto motions = free_motions(is_swing(trace.column), swing_radps, size, run.period_s);
    Eigen::Map<Eigen::VectorXd> window(left.data() + first, size);
    const Eigen::VectorXd present = window.unaryExpr([](double x) { return std::isfinite(x) ? 1.0 : 0.0; });
    const Eigen::VectorXd known = window.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
    window -= motions * (present.asDiagonal() * motions).colPivHouseholderQr().solve(known).eval();
  }
  return left;
}

class ViewBuilder {
 public:
  ViewBuilder(ResidualView& view, const Trace& trace, const Run& run)
      : view_(view), time_s_(trace.time_s), run_(run), rows_(trace.measured.size()) {
    const auto output =
        std::find(kOutputNames.begin(), kOutputNames.end(), trace.column) - kOutputNames.begin();
    if (output == kSlewAngle || output == kTangentialSwing) drive_ = kSlewAngle, swing_ = kTangentialSwing;
  }

  void add_all() {
    const bool radial = drive_ == kTrolleyPosition;
    add("time [s]", time_s_);
    if (run_.has(drive_)) {
      const std::string unit = radial ? "m" : "rad";
      const std::string name = radial ? "trolley" : "slew";
      add(name + " position [" + unit + "]", measured_on_grid(run_, drive_));
      add(name + " speed [" + unit + "/s]", rate(drive_));
    }
    if (run_.has(swing_)) {
      add("swing [rad]", measured_on_grid(run_, swing_));
      add("swing rate [rad/s]", rate(swing_));
    }
    if (run_.has(drive_)) add(radial ? "trolley command [V]" : "slew command [V]", command());
  }

 private:
  [[nodiscard]] std::vector<double> rate(Output output) const {
    return savitzky_golay(measured_on_grid(run_, output), run_.period_s, smoothing_half_width(run_.period_s))
        .rate;
  }
  [[nodiscard]] std::vector<double> command() const {
    std::vector<double> volts;
    for (const plant::PerAxis& command : run_.command_v)
      volts.push_back(command[drive_ == kTrolleyPosition ? plant::kTrolley : plant::kSlew]);
    return volts;
  }
  void add(const std::string& label, const std::vector<double>& values) {
    auto found = std::find_if(view_.against.begin(), view_.against.end(),
                              [&](const Abscissa& a) { return a.label == label; });
    if (found == view_.against.end()) found = view_.against.insert(found, {label, {}});
    // NaN for runs without the column.
    found->values.resize(view_.baseline.size() - rows_, std::nan(""));
    found->values.insert(found->values.end(), values.begin(), values.end());
  }

  ResidualView& view_;
  const std::vector<double>& time_s_;
  const Run& run_;
  std::size_t rows_;
  Output drive_ = kTrolleyPosition, swing_ = kRadialSwing;
};

}  // namespace

std::string residual_unit(const std::string& column) { return column.ends_with("_m") ? "mm" : "mrad"; }

std::string short_name(const std::string& run) {
  const std::filesystem::path path{run};
  return (path.parent_path().filename() / path.filename()).string();
}

std::vector<ResidualView> residual_views(const Diagnosis& diagnosis, const configuration::Rig& rig,
                                         const std::vector<Run>& test) {
  std::vector<ResidualView> views;
  for (const Trace& trace : diagnosis.traces) {
    const auto run =
        std::find_if(test.begin(), test.end(), [&](const Run& r) { return r.name == trace.run; });
    if (run == test.end() || run->rows() != trace.measured.size()) continue;
    auto view = std::find_if(views.begin(), views.end(),
                             [&](const ResidualView& v) { return v.column == trace.column; });
    if (view == views.end())
      view = views.insert(view, {trace.column, residual_unit(trace.column), {}, {}, {}});
    const auto before = without_start(trace, trace.baseline, *run, rig);
    const auto after = without_start(trace, trace.extended, *run, rig);
    view->baseline.insert(view->baseline.end(), before.begin(), before.end());
    view->extended.insert(view->extended.end(), after.begin(), after.end());
    ViewBuilder(*view, trace, *run).add_all();
  }
  for (ResidualView& view : views)
    for (Abscissa& abscissa : view.against) abscissa.values.resize(view.baseline.size(), std::nan(""));
  return views;
}

}  // namespace crane::diagnosis
