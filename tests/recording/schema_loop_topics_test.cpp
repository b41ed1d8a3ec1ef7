// Compares the schema that is read from crane.idl with the C structs of idlc and the codec of the bus in
// every field of every topic of the loop, and in those of twin and adaptation.
#include "topic_schema.hpp"

namespace crane::recording {
namespace {

TEST(TopicSchema, ReadsEveryFieldOfState) {
  Filler f;
  msg::State s{};
  f.header(s.header);
  for (auto& count : s.counts) f.number(count);
  for (double* value : {&s.trolley_position_m, &s.slew_angle_rad, &s.cable_length_m, &s.trolley_speed_mps,
                        &s.slew_speed_radps, &s.cable_speed_mps, &s.swing_radial_rad, &s.swing_tangential_rad,
                        &s.swing_radial_radps, &s.swing_tangential_radps})
    *value = f.real();
  for (double& value : s.applied_v) value = f.real();
  f.number(s.applied_command_tick);
  for (int i = 0; i < 3; ++i) {
    f.flag(s.brake_closed[i]);
    s.limit_low[i] = i == 0;
    s.limit_high[i] = i == 1;
  }
  s.command_stale = s.watchdog_dropped = true;
  f.number(s.overruns);
  s.latch_reason = crane_LATCH_LOST_COUNTS;
  s.position_known[0] = s.mark_active[1] = s.mark_found[2] = true;
  f.number(s.configuration);
  f.number(s.crc32c);
  const ordered_json want{{"header", expected(s.header)},
                          {"counts", expected(s.counts)},
                          {"trolley_position_m", s.trolley_position_m},
                          {"slew_angle_rad", s.slew_angle_rad},
                          {"cable_length_m", s.cable_length_m},
                          {"trolley_speed_mps", s.trolley_speed_mps},
                          {"slew_speed_radps", s.slew_speed_radps},
                          {"cable_speed_mps", s.cable_speed_mps},
                          {"swing_radial_rad", s.swing_radial_rad},
                          {"swing_tangential_rad", s.swing_tangential_rad},
                          {"swing_radial_radps", s.swing_radial_radps},
                          {"swing_tangential_radps", s.swing_tangential_radps},
                          {"applied_v", expected(s.applied_v)},
                          {"applied_command_tick", s.applied_command_tick},
                          {"brake_closed", expected(s.brake_closed)},
                          {"limit_low", expected(s.limit_low)},
                          {"limit_high", expected(s.limit_high)},
                          {"estop_pressed", false},
                          {"command_stale", true},
                          {"command_invalid", false},
                          {"watchdog_dropped", true},
                          {"overruns", s.overruns},
                          {"latch_reason", "LATCH_LOST_COUNTS"},
                          {"position_known", {true, false, false}},
                          {"mark_active", {false, true, false}},
                          {"mark_found", {false, false, true}},
                          {"configuration", s.configuration},
                          {"crc32c", s.crc32c}};
  EXPECT_EQ(through_the_codec(topics::state, s), want);
}

TEST(TopicSchema, ReadsEveryFieldOfReferenceAndContribution) {
  Filler f;
  msg::Reference r{};
  f.header(r.header);
  for (auto& axis : r.axis) f.axis(axis);
  for (double& value : r.start) value = f.real();
  for (auto* values : {&r.swing_rad, &r.swing_radps})
    for (double& value : *values) value = f.real();
  for (double& value : r.feed_forward_v) value = f.real();
  r.moving = true;
  f.number(r.move_number);
  r.second_writer = true;
  f.number(r.configuration);
  f.number(r.crc32c);
  EXPECT_EQ(through_the_codec(topics::reference, r),
            (ordered_json{{"header", expected(r.header)},
                          {"axis", expected(r.axis)},
                          {"start", expected(r.start)},
                          {"swing_rad", expected(r.swing_rad)},
                          {"swing_radps", expected(r.swing_radps)},
                          {"feed_forward_v", expected(r.feed_forward_v)},
                          {"moving", true},
                          {"move_number", r.move_number},
                          {"second_writer", true},
                          {"configuration", r.configuration},
                          {"crc32c", r.crc32c}}));
  msg::Contribution c{};
  f.header(c.header);
  for (double& value : c.drive_v) value = f.real();
  for (auto& axis : c.correction) f.axis(axis);
  c.second_writer = true;
  f.number(c.configuration);
  f.number(c.crc32c);
  const ordered_json want{{"header", expected(c.header)},         {"drive_v", expected(c.drive_v)},
                          {"correction", expected(c.correction)}, {"second_writer", true},
                          {"configuration", c.configuration},     {"crc32c", c.crc32c}};
  EXPECT_EQ(through_the_codec(topics::tracking, c), want);
  EXPECT_EQ(through_the_codec(topics::anti_swing, c), want);
}

TEST(TopicSchema, ReadsEveryFieldOfDemandAndCommand) {
  Filler f;
  msg::Demand d{};
  f.header(d.header);
  for (int i = 0; i < 3; ++i) {
    d.control_v[i] = f.real();
    d.friction_v[i] = f.real();
    d.total_v[i] = f.real();
  }
  d.second_writer = true;
  f.number(d.configuration);
  f.number(d.crc32c);
  EXPECT_EQ(through_the_codec(topics::demand, d), (ordered_json{{"header", expected(d.header)},
                                                                {"control_v", expected(d.control_v)},
                                                                {"friction_v", expected(d.friction_v)},
                                                                {"total_v", expected(d.total_v)},
                                                                {"second_writer", true},
                                                                {"configuration", d.configuration},
                                                                {"crc32c", d.crc32c}}));
  msg::Command c{};
  f.header(c.header);
  for (double& value : c.drive_v) value = f.real();
  c.brake_release[1] = c.watchdog_permission = c.homing[2] = true;
  f.number(c.crc32c);
  EXPECT_EQ(through_the_codec(topics::command, c), (ordered_json{{"header", expected(c.header)},
                                                                 {"drive_v", expected(c.drive_v)},
                                                                 {"brake_release", {false, true, false}},
                                                                 {"watchdog_permission", true},
                                                                 {"homing", {false, false, true}},
                                                                 {"crc32c", c.crc32c}}));
}

TEST(TopicSchema, ReadsEveryFieldOfTwin) {
  Filler f;
  msg::Twin t{};
  f.header(t.header);
  t.state = crane_TWIN_DEVIATES;
  auto columns = ordered_json::array();
  for (auto& column : t.column) {
    column = {f.real(), f.real(), f.real()};
    columns.push_back(
        {{"predicted", column.predicted}, {"residual", column.residual}, {"band", column.band}});
  }
  t.evidence = f.real();
  f.text(t.cause);
  f.text(t.axis);
  t.size = f.real();
  t.size_std = f.real();
  f.text(t.unit);
  t.learnt_share = f.real();
  f.number(t.judged_ticks);
  f.number(t.gaps);
  f.number(t.crc32c);
  EXPECT_EQ(through_the_codec(topics::twin, t), (ordered_json{{"header", expected(t.header)},
                                                              {"state", "TWIN_DEVIATES"},
                                                              {"column", columns},
                                                              {"evidence", t.evidence},
                                                              {"cause", t.cause},
                                                              {"axis", t.axis},
                                                              {"size", t.size},
                                                              {"size_std", t.size_std},
                                                              {"unit", t.unit},
                                                              {"learnt_share", t.learnt_share},
                                                              {"judged_ticks", t.judged_ticks},
                                                              {"gaps", t.gaps},
                                                              {"crc32c", t.crc32c}}));
}

ordered_json levels(const msg::AdaptedFriction& a) {
  return {{"coulomb_v", a.coulomb_v},
          {"coulomb_std_v", a.coulomb_std_v},
          {"viscous_v", a.viscous_v},
          {"viscous_std_v", a.viscous_std_v},
          {"static_v", a.static_v},
          {"static_std_v", a.static_std_v},
          {"used_coulomb_v", a.used_coulomb_v},
          {"used_viscous_v", a.used_viscous_v},
          {"used_static_v", a.used_static_v},
          {"blocks", a.blocks},
          {"break_aways", a.break_aways}};
}

void fill(Filler& f, msg::AdaptedFriction& a) {
  for (double* value : {&a.coulomb_v, &a.coulomb_std_v, &a.viscous_v, &a.viscous_std_v, &a.static_v,
                        &a.static_std_v, &a.used_coulomb_v, &a.used_viscous_v, &a.used_static_v})
    *value = f.real();
  f.number(a.blocks);
  f.number(a.break_aways);
}

TEST(TopicSchema, ReadsEveryFieldOfAdaptation) {
  Filler f;
  msg::Adaptation a{};
  f.header(a.header);
  auto axes = ordered_json::array();
  for (auto& axis : a.axis) {
    axis.phase = crane_ADAPTATION_FROZEN;
    axis.freeze = crane_FREEZE_IMPLAUSIBLE;
    fill(f, axis.positive);
    fill(f, axis.negative);
    for (double* value : {&axis.innovation_v, &axis.innovation_std_v, &axis.move_residual_v,
                          &axis.previous_residual_v, &axis.confidence})
      *value = f.real();
    for (auto* count : {&axis.installed, &axis.roll_backs, &axis.limit_cycles, &axis.refused_blocks})
      f.number(*count);
    axes.push_back({{"phase", "ADAPTATION_FROZEN"},
                    {"freeze", "FREEZE_IMPLAUSIBLE"},
                    {"positive", levels(axis.positive)},
                    {"negative", levels(axis.negative)},
                    {"innovation_v", axis.innovation_v},
                    {"innovation_std_v", axis.innovation_std_v},
                    {"move_residual_v", axis.move_residual_v},
                    {"previous_residual_v", axis.previous_residual_v},
                    {"confidence", axis.confidence},
                    {"installed", axis.installed},
                    {"roll_backs", axis.roll_backs},
                    {"limit_cycles", axis.limit_cycles},
                    {"refused_blocks", axis.refused_blocks}});
  }
  for (double* value : {&a.load_mass_kg, &a.load_mass_std_kg, &a.pendulum_length_m, &a.pendulum_length_std_m,
                        &a.swing_offset_rad[0], &a.swing_offset_rad[1], &a.swing_offset_std_rad[0],
                        &a.swing_offset_std_rad[1]})
    *value = f.real();
  f.number(a.moves);
  f.number(a.crc32c);
  EXPECT_EQ(through_the_codec(topics::adaptation, a),
            (ordered_json{{"header", expected(a.header)},
                          {"axis", axes},
                          {"load_mass_kg", a.load_mass_kg},
                          {"load_mass_std_kg", a.load_mass_std_kg},
                          {"pendulum_length_m", a.pendulum_length_m},
                          {"pendulum_length_std_m", a.pendulum_length_std_m},
                          {"swing_offset_rad", expected(a.swing_offset_rad)},
                          {"swing_offset_std_rad", expected(a.swing_offset_std_rad)},
                          {"moves", a.moves},
                          {"crc32c", a.crc32c}}));
}

}  // namespace
}  // namespace crane::recording
