#include "crane/plant/parameters.hpp"

#include <sstream>

namespace crane::plant {

std::vector<std::string> Parameters::problems() const {
  constexpr double kLargest = 1e9;  // excludes infinity; NaN is outside every range
  std::vector<std::string> found;
  const auto report = [&found](const char* name, double value, const char* rule) {
    std::ostringstream line;
    line << name << " = " << value << ": " << rule;
    found.push_back(line.str());
  };
  const auto positive = [&](const char* name, double value) {
    if (!(value > 0 && value < kLargest)) report(name, value, "must be in (0, 1e9)");
  };
  const auto not_negative = [&](const char* name, double value) {
    if (!(value >= 0 && value < kLargest)) report(name, value, "must be in [0, 1e9)");
  };
  positive("gravity_mps2", gravity_mps2);
  positive("trolley_inertia_kg", trolley_inertia_kg);
  not_negative("trolley_mass_kg", trolley_mass_kg);
  not_negative("load_mass_kg", load_mass_kg);
  positive("jib_inertia_kgm2", jib_inertia_kgm2);
  positive("trolley_gain_mps2pv", trolley_gain_mps2pv);
  positive("slew_gain_radps2pv", slew_gain_radps2pv);
  positive("hoist_gain_mpspv", hoist_gain_mpspv);
  positive("hoist_lag_s", hoist_lag_s);
  return found;
}

}  // namespace crane::plant
