#include "dashboard/rig_text.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "crane/plant/coordinates.hpp"
#include "dashboard/situation.hpp"

namespace crane::dashboard {
namespace {

const char* name_of(configuration::RigKind kind) {
  constexpr std::array kNames{"tower", "gantry", "drive_axis", "pendulum"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string rig_text(const configuration::Rig& rig) {
  nlohmann::ordered_json json{{"name", rig.name},
                              {"kind", name_of(rig.kind)},
                              {"period_s", rig.period_s},
                              {"has_load", rig.has_load()},
                              {"swing_limit_rad", rig.limits.swing_limit_rad},
                              {"axes", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& drive = rig.drives[i];
    json["axes"].push_back({{"name", plant::kCoordinates[i].name},
                            {"present", drive.present},
                            {"low_limit", drive.low_limit},
                            {"high_limit", drive.high_limit},
                            {"soft_margin", drive.soft_margin},
                            {"reference_speed", drive.reference_speed},
                            {"reference_acceleration", drive.reference_acceleration}});
  }
  return text_of(json);
}

}  // namespace crane::dashboard
