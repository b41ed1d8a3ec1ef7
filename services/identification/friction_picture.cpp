#include "identification/friction_picture.hpp"

#include <cmath>

#include "crane/control/zero_phase.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/plot/curves.hpp"
#include "identification/axis_data.hpp"

namespace crane::identification {
namespace {

using plot::CurvePoint;
using plot::CurveStyle;

/// Measured friction over speed: voltage minus acceleration / K_m, from the rows of the midpoint form.
std::vector<CurvePoint> measured_friction(const FrictionPictureData& data, double gain) {
  const auto filtered = [&data](const std::vector<double>& series) {
    return data.cutoff_ratio > 0 ? control::zero_phase_butterworth(series, data.cutoff_ratio) : series;
  };
  const auto x = filtered(data.run->position), u = filtered(data.run->drive_v);
  const double period_s = data.period_s;
  std::vector<CurvePoint> points;
  for (std::size_t k = 2; k < x.size(); k += 2) {  // every second row
    const double acceleration = (x[k] - 2 * x[k - 1] + x[k - 2]) / (period_s * period_s);
    points.push_back({(x[k] - x[k - 2]) / (2 * period_s), (u[k - 1] + u[k - 2]) / 2 - acceleration / gain});
  }
  return points;
}

/// Curve of the fitted friction over the range of speeds, with the step at standstill.
std::vector<CurvePoint> fitted(const identification::FrictionEstimate& e,
                               const std::vector<CurvePoint>& rows) {
  double low = 0, high = 0;
  for (const CurvePoint& row : rows) {
    low = std::min(low, row.x);
    high = std::max(high, row.x);
  }
  return {{low, e.viscous_negative.value * low - e.coulomb_negative.value},
          {0, -e.coulomb_negative.value},
          {0, e.coulomb_positive.value},
          {high, e.viscous_positive.value * high + e.coulomb_positive.value}};
}

std::vector<CurvePoint> over_time(const std::vector<double>& values, double period_s) {
  std::vector<CurvePoint> points;
  for (std::size_t k = 0; k < values.size(); ++k)
    points.push_back({static_cast<double>(k) * period_s, values[k]});
  return points;
}

}  // namespace

void draw_friction(const std::filesystem::path& file, const FrictionExperimentResult& result,
                   const FrictionPictureData& data) {
  const bool trolley = result.axis == plant::kTrolley;
  const std::string unit = trolley ? "m" : "rad";
  const auto& estimates = result.estimates;
  const auto rows = measured_friction(data, estimates.midpoint.gain.value);
  const std::string position = std::string{plant::kCoordinates[result.axis].name} + " [" + unit + "]";
  plot::draw_curves(
      file,
      result.rig + ", " + plant::kCoordinates[result.axis].name +
          ": measured and fitted friction; steps compared with the linear axis",
      {{"speed [" + unit + "/s]",
        "friction [V]",
        {{"measured", CurveStyle::dots, rows},
         {"midpoint form", CurveStyle::line, fitted(estimates.midpoint, rows)},
         {"dissertation's form", CurveStyle::dashes, fitted(estimates.dissertation, rows)}}},
       {"time [s]",
        position,
        {{"compensated", CurveStyle::line, over_time(*data.compensated, data.period_s)},
         {"linear axis", CurveStyle::dashes, over_time(*data.model, data.period_s)},
         {"not compensated", CurveStyle::line, over_time(*data.uncompensated, data.period_s)}}}});
}

}  // namespace crane::identification
