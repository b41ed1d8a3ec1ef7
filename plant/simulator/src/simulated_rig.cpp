#include "crane/simulator/simulated_rig.hpp"

#include <cmath>
#include <sstream>

#include "crane/plant/coordinates.hpp"
#include "crane/plant/parameter_fields.hpp"
#include "crane/plant/term.hpp"

namespace crane::simulator {
namespace {

class Report {
 public:
  void require(bool ok, const std::string& name, double value, const std::string& rule) {
    if (ok) return;
    std::ostringstream line;
    line << name << " = " << value << ": " << rule;
    lines.push_back(line.str());
  }
  void positive(const std::string& name, double value) {
    require(value > 0 && std::isfinite(value), name, value, "must be positive and finite");
  }
  void delay(const std::string& name, double value) {
    require(value >= 0 && value <= 10, name, value, "must be in [0, 10] s");
  }
  void sign(const std::string& name, int value) {
    require(value == 1 || value == -1, name, value, "must be 1 or -1");
  }
  std::vector<std::string> lines;
};

void check_drive(const SimulatedDrive& drive, const std::string& name, double start, Report& report) {
  report.sign(name + ".sign", drive.sign);
  report.positive(name + ".brake_deceleration", drive.brake_deceleration);
  report.delay(name + ".brake_close_time_s", drive.brake_close_time_s);
  report.delay(name + ".brake_open_time_s", drive.brake_open_time_s);
  report.require(!std::isnan(drive.low_switch), name + ".low_switch", drive.low_switch, "must be a number");
  report.require(!std::isnan(drive.high_switch), name + ".high_switch", drive.high_switch,
                 "must be a number");
  report.require(!std::isnan(drive.mark), name + ".mark", drive.mark, "must be a number");
  report.require(drive.low_stop < drive.high_stop, name + ".low_stop", drive.low_stop,
                 "must be below high_stop");
  report.require(start >= drive.low_stop && start <= drive.high_stop, name + " start", start,
                 "must be between the end stops");
}

}  // namespace

std::vector<std::string> SimulatedRig::problems() const {
  Report report;
  report.lines = parameters.problems();
  for (const std::string& problem : plant::problems(terms)) report.lines.push_back(problem);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const double at = plant::position(start, static_cast<plant::Axis>(i));
    check_drive(drives[i], std::string{"drives."} + plant::kCoordinates[i].axis, at, report);
  }
  for (std::size_t i = 0; i < encoders.size(); ++i) {
    const std::string name = std::string{"encoders."} + plant::kCoordinates[i].axis;
    report.positive(name + ".counts_per_unit", encoders[i].counts_per_unit);
    report.sign(name + ".sign", encoders[i].sign);
  }
  for (const double value : plant::to_array(start)) {
    report.require(std::isfinite(value), "start", value, "must be finite");
  }
  report.require(start.cable_m > 0, "start.cable_m", start.cable_m, "must be positive");
  const auto swing = [&](const char* name, double angle) {
    report.require(plant::kSwingAngles.contains(angle), name, angle, plant::kSwingAngles.rule());
  };
  swing("start.radial_rad", start.radial_rad);
  swing("start.tangential_rad", start.tangential_rad);
  report.positive("period_s", period_s);
  report.positive("watchdog_timeout_s", watchdog_timeout_s);
  report.delay("watchdog_permit_s", watchdog_permit_s);
  return report.lines;
}

}  // namespace crane::simulator
