#include "friction_compensation/adaptation_sample.hpp"

namespace crane::services {
namespace {

// crane/control does not include the messages: its enumerators repeat the order of crane.idl.
static_assert(static_cast<int>(control::AdaptationPhase::learning) == crane_ADAPTATION_LEARNING);
static_assert(static_cast<int>(control::AdaptationFreeze::limit_cycle) == crane_FREEZE_LIMIT_CYCLE);
static_assert(static_cast<int>(control::AdaptationFreeze::not_executed) == crane_FREEZE_NOT_EXECUTED);
static_assert(static_cast<int>(control::AdaptationFreeze::implausible) == crane_FREEZE_IMPLAUSIBLE);

msg::AdaptedFriction direction_of(const control::DirectionReport& report) noexcept {
  return {.coulomb_v = report.estimate.coulomb_v,
          .coulomb_std_v = report.std_dev.coulomb_v,
          .viscous_v = report.estimate.viscous_vspm,
          .viscous_std_v = report.std_dev.viscous_vspm,
          .static_v = report.estimate.static_v,
          .static_std_v = report.std_dev.static_v,
          .used_coulomb_v = report.used.coulomb_v,
          .used_viscous_v = report.used.viscous_vspm,
          .used_static_v = report.used.static_v,
          .blocks = report.blocks,
          .break_aways = report.break_aways};
}

msg::AxisAdaptation axis_of(const control::AxisReport& report) noexcept {
  return {.phase = static_cast<crane_AdaptationPhase>(report.phase),
          .freeze = static_cast<crane_AdaptationFreeze>(report.freeze),
          .positive = direction_of(report.direction[0]),
          .negative = direction_of(report.direction[1]),
          .innovation_v = report.innovation_v,
          .innovation_std_v = report.innovation_std_v,
          .move_residual_v = report.move_residual_v,
          .previous_residual_v = report.previous_residual_v,
          .confidence = report.confidence,
          .installed = report.installed,
          .roll_backs = report.roll_backs,
          .limit_cycles = report.limit_cycles,
          .refused_blocks = report.refused_blocks};
}

}  // namespace

msg::Adaptation adaptation_sample(const msg::Header& header,
                                  const control::AdaptationReport& report) noexcept {
  msg::Adaptation sample{};
  sample.header = header;
  for (std::size_t i = 0; i < control::kAdaptedAxes; ++i) {
    sample.axis[i] = axis_of(report.axis[i]);
    sample.swing_offset_rad[i] = report.swing_offset_rad[i].value;
    sample.swing_offset_std_rad[i] = report.swing_offset_rad[i].std_dev;
  }
  sample.load_mass_kg = report.load_mass_kg.value;
  sample.load_mass_std_kg = report.load_mass_kg.std_dev;
  sample.pendulum_length_m = report.pendulum_length_m.value;
  sample.pendulum_length_std_m = report.pendulum_length_m.std_dev;
  sample.moves = report.moves;
  return sample;
}

}  // namespace crane::services
