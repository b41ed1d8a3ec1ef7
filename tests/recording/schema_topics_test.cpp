// Compares the schema that is read from crane.idl with the C structs of idlc and the codec of the bus in
// every field of every topic between operator, supervisor and processes.
#include "topic_schema.hpp"

namespace crane::recording {
namespace {

TEST(TopicSchema, ReadsEveryFieldOfSupervisor) {
  Filler f;
  msg::SupervisorStatus s{};
  f.header(s.header);
  s.state = crane_STATE_STOP_C1;
  s.cause = crane_CAUSE_STOP_TIMEOUT;
  s.demand_stale = s.demand_clamped = s.swing_exceeded = s.estop_active = s.configuration_differs = true;
  for (int i = 0; i < 3; ++i) {
    s.low_limit[i] = f.real();
    s.high_limit[i] = f.real();
    s.volt_limit_v[i] = f.real();
  }
  for (auto* value :
       {&s.clamped_count, &s.rejected_count, &s.missing_demand_count, &s.move.number, &s.move.request_id})
    f.number(*value);
  f.text(s.move.client);
  s.move.kind = crane_REQUEST_FOLLOW;
  s.move.selected[2] = true;
  for (double& value : s.move.target) value = f.real();
  auto move_sines = ordered_json::array();
  for (auto& sine : s.move.sine) {
    sine = {f.real(), f.real(), f.real()};
    move_sines.push_back(
        {{"amplitude", sine.amplitude}, {"frequency_hz", sine.frequency_hz}, {"phase_rad", sine.phase_rad}});
  }
  s.move.duration_s = f.real();
  s.homing[1] = true;
  for (double& value : s.homing_speed) value = f.real();
  s.homing_failure = crane_HOMING_MARK_STUCK;
  for (double& value : s.jog_deflection) value = f.real();
  s.mode = crane_MODE_MANUAL;
  f.number(s.crc32c);
  const ordered_json want{{"header", expected(s.header)},
                          {"state", "STATE_STOP_C1"},
                          {"cause", "CAUSE_STOP_TIMEOUT"},
                          {"state_stale", false},
                          {"demand_stale", true},
                          {"demand_invalid", false},
                          {"demand_clamped", true},
                          {"envelope_violated", false},
                          {"swing_exceeded", true},
                          {"bridge_latched", false},
                          {"estop_active", true},
                          {"second_writer", false},
                          {"configuration_differs", true},
                          {"low_limit", expected(s.low_limit)},
                          {"high_limit", expected(s.high_limit)},
                          {"volt_limit_v", expected(s.volt_limit_v)},
                          {"clamped_count", s.clamped_count},
                          {"rejected_count", s.rejected_count},
                          {"missing_demand_count", s.missing_demand_count},
                          {"move",
                           {{"number", s.move.number},
                            {"request_id", s.move.request_id},
                            {"client", s.move.client},
                            {"kind", "REQUEST_FOLLOW"},
                            {"selected", {false, false, true}},
                            {"target", expected(s.move.target)},
                            {"sine", move_sines},
                            {"duration_s", s.move.duration_s}}},
                          {"homing", {false, true, false}},
                          {"homing_speed", expected(s.homing_speed)},
                          {"homing_failure", "HOMING_MARK_STUCK"},
                          {"jog_deflection", expected(s.jog_deflection)},
                          {"mode", "MODE_MANUAL"},
                          {"crc32c", s.crc32c}};
  EXPECT_EQ(through_the_codec(topics::supervisor, s), want);
}

TEST(TopicSchema, ReadsEveryFieldOfJog) {
  Filler f;
  msg::Jog j{};
  f.header(j.header);
  f.number(j.request_id);
  f.text(j.client);
  j.engaged = true;
  for (double& value : j.deflection) value = f.real();
  f.number(j.crc32c);
  EXPECT_EQ(through_the_codec(topics::jog, j), (ordered_json{{"header", expected(j.header)},
                                                             {"request_id", j.request_id},
                                                             {"client", j.client},
                                                             {"engaged", true},
                                                             {"deflection", expected(j.deflection)},
                                                             {"crc32c", j.crc32c}}));
}

TEST(TopicSchema, ReadsEveryFieldOfRequestAndReply) {
  Filler f;
  msg::Request q{};
  f.header(q.header);
  f.number(q.id);
  f.text(q.client);
  q.kind = crane_REQUEST_KICK;
  f.number(q.apply_tick);
  q.selected[2] = true;
  for (double& value : q.target) value = f.real();
  f.number(q.until_tick);
  auto sines = ordered_json::array();
  for (auto& sine : q.sine) {
    sine = {f.real(), f.real(), f.real()};
    sines.push_back(
        {{"amplitude", sine.amplitude}, {"frequency_hz", sine.frequency_hz}, {"phase_rad", sine.phase_rad}});
  }
  for (double& value : q.kick_radps) value = f.real();
  q.duration_s = f.real();
  q.mode = crane_MODE_MAINTENANCE;
  f.number(q.crc32c);
  EXPECT_EQ(through_the_codec(topics::request, q), (ordered_json{{"header", expected(q.header)},
                                                                 {"id", q.id},
                                                                 {"client", q.client},
                                                                 {"kind", "REQUEST_KICK"},
                                                                 {"apply_tick", q.apply_tick},
                                                                 {"selected", {false, false, true}},
                                                                 {"target", expected(q.target)},
                                                                 {"until_tick", q.until_tick},
                                                                 {"sine", sines},
                                                                 {"kick_radps", expected(q.kick_radps)},
                                                                 {"duration_s", q.duration_s},
                                                                 {"mode", "MODE_MAINTENANCE"},
                                                                 {"crc32c", q.crc32c}}));
  msg::Reply p{};
  f.header(p.header);
  f.number(p.request_id);
  f.text(p.client);
  f.text(p.reason);
  p.accepted = true;
  f.number(p.crc32c);
  EXPECT_EQ(through_the_codec(topics::reply, p), (ordered_json{{"header", expected(p.header)},
                                                               {"request_id", p.request_id},
                                                               {"client", p.client},
                                                               {"accepted", true},
                                                               {"reason", p.reason},
                                                               {"crc32c", p.crc32c}}));
}

TEST(TopicSchema, ReadsEveryFieldOfNodeAndEvent) {
  Filler f;
  msg::NodeStatus n{};
  f.header(n.header);
  f.number(n.node);
  f.text(n.name);
  f.text(n.vendor);
  f.text(n.version);
  f.text(n.controller);
  f.number(n.pid);
  n.phase = crane_PHASE_STOPPING;
  for (auto* value : {&n.ticks, &n.lost_ticks, &n.late_samples, &n.duplicate_samples, &n.rejected_samples,
                      &n.foreign_samples, &n.refused_samples})
    f.number(*value);
  n.step_mean_us = f.real();
  n.step_max_us = f.real();
  f.number(n.crc32c);
  const ordered_json want{{"header", expected(n.header)},
                          {"node", n.node},
                          {"name", n.name},
                          {"vendor", n.vendor},
                          {"version", n.version},
                          {"controller", n.controller},
                          {"pid", n.pid},
                          {"phase", "PHASE_STOPPING"},
                          {"ticks", n.ticks},
                          {"lost_ticks", n.lost_ticks},
                          {"late_samples", n.late_samples},
                          {"duplicate_samples", n.duplicate_samples},
                          {"rejected_samples", n.rejected_samples},
                          {"foreign_samples", n.foreign_samples},
                          {"refused_samples", n.refused_samples},
                          {"step_mean_us", n.step_mean_us},
                          {"step_max_us", n.step_max_us},
                          {"crc32c", n.crc32c}};
  EXPECT_EQ(through_the_codec(topics::node, n), want);
  msg::Event e{};
  f.header(e.header);
  e.severity = crane_SEVERITY_ERROR;
  f.text(e.node);
  f.text(e.code);
  f.text(e.what);
  f.text(e.remedy);
  f.number(e.crc32c);
  EXPECT_EQ(through_the_codec(topics::event, e), (ordered_json{{"header", expected(e.header)},
                                                               {"severity", "SEVERITY_ERROR"},
                                                               {"node", e.node},
                                                               {"code", e.code},
                                                               {"what", e.what},
                                                               {"remedy", e.remedy},
                                                               {"crc32c", e.crc32c}}));
}

}  // namespace
}  // namespace crane::recording
