#include <sstream>
#include <tuple>

#include "crane/bring_up/calibration.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/fields/shortest.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::bring_up {
namespace {

namespace fs = std::filesystem;
using configuration::ConfigurationError;

/// Text of a number that gives the same floating-point number when it is read.
std::string exact(double value) {
  std::string found = fields::shortest(value);
  return found.find_first_of(".en") == std::string::npos ? found + ".0" : found;
}

std::string text_of(const configuration::Rig& rig, const Calibration& calibration) {
  std::ostringstream out;
  out << "# Calibration of " << rig.name << ", written by crane hw calibrate.\n"
      << "extends = " << configuration::toml_string(fs::absolute(rig.path).lexically_normal().string())
      << '\n'
      << "name = " << configuration::toml_string(rig.name) << '\n';
  for (std::size_t i = 0; i < kDrives; ++i)
    if (rig.drives[i].present)
      out << "\n[drive." << coordinate_name(i) << "]\nsign = " << calibration.drive_sign[i]
          << "  # direction of motion at a positive voltage\n";
  for (std::size_t i = 0; i < kCounters; ++i) {
    if (rig.encoders[i].counts_per_unit <= 0) continue;
    const auto unit = coordinate_unit(i);
    out << "\n[encoder." << coordinate_name(i) << "]\nsign = " << calibration.encoder_sign[i]
        << "\ncounts_per_" << unit << " = " << exact(calibration.counts_per_unit[i]) << "  # counts per "
        << unit << '\n';
  }
  out << "\n[start]  # position of the crane at the calibration, load at rest; the encoders are "
         "incremental\n";
  for (std::size_t i = 0; i < kDrives; ++i)
    if (rig.drives[i].present)
      out << plant::kCoordinates[i].column << " = " << exact(calibration.position[i]) << "  # "
          << coordinate_unit(i) << '\n';
  for (std::size_t i = kDrives; i < kCounters; ++i)
    if (rig.measures(i)) out << coordinate_name(i) << "_rad = 0.0  # rad\n";
  return out.str();
}

}  // namespace

void require_own_file(const configuration::Rig& rig, const fs::path& file) {
  if (!fs::exists(file)) return;
  if (fs::equivalent(file, rig.path))
    throw ConfigurationError(
        {file.string() + ": is the rig file itself; write the calibration beside it (--out)"});
  std::string other;
  try {
    other = configuration::load_rig(file).name;
  } catch (const ConfigurationError&) {
    throw ConfigurationError({file.string() + ": exists and is no rig file; choose another --out"});
  }
  if (other != rig.name)
    throw ConfigurationError({file.string() + ": name = " + other +
                              ": is the calibration of another rig than " + rig.name +
                              "; choose another --out, or --rig " + other});
}

std::string calibration_file(const configuration::Rig& rig, const Calibration& calibration,
                             const fs::path& file) {
  require_own_file(rig, file);
  auto text = text_of(rig, calibration);
  std::ignore = configuration::parse_rig(text, file.string());
  return text;
}

}  // namespace crane::bring_up
