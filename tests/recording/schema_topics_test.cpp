// Compares the schema that is read from crane.idl with the C structs of idlc and the codec of the bus in
// every field of every topic.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"
#include "crane/topics.hpp"

namespace crane::recording {
namespace {

using nlohmann::ordered_json;

/// Values that differ between fields.
class Filler {
 public:
  double real() { return 0.5 * ++count_ - 20; }
  template <class T>
  void number(T& value) {
    value = static_cast<T>(1'000'000 + ++count_);
  }
  template <class E>
  void enumeration(E& value, int choices) {
    value = static_cast<E>(++count_ % choices);
  }
  void flag(bool& value) { value = ++count_ % 2 == 0; }
  template <std::size_t N>
  void text(char (&value)[N]) {
    std::snprintf(value, N, "text %d", ++count_);
  }
  void header(msg::Header& h) {
    number(h.tick);
    h.sample_time_ns = -123456789012345;
    enumeration(h.source, 11);
    number(h.epoch);
  }
  void axis(msg::AxisReference& a) {
    a.position = real();
    a.speed = real();
    a.acceleration = real();
  }

 private:
  int count_ = 0;
};

const Schema& schema() {
  static const Schema kSchema{topics::idl_text()};
  return kSchema;
}

template <class T>
ordered_json through_the_codec(const topics::Topic<T>& topic, const T& sample) {
  const bus::CdrCodec& codec = bus::CdrCodec::of(*topic.description.descriptor);
  std::vector<std::uint8_t> payload(4 + codec.max_encoded_bytes());
  payload[1] = 1;
  const std::size_t size = codec.encode(&sample, std::span{payload}.subspan(4));
  EXPECT_GT(size, 0U);
  payload.resize(4 + size);
  return schema().decode(topic.description.type, payload);
}

ordered_json expected(const msg::Header& h) {
  const std::array names{"SOURCE_NONE",     "SOURCE_PLANT",      "SOURCE_BRIDGE",   "SOURCE_PLANNER",
                         "SOURCE_TRACKING", "SOURCE_ANTI_SWING", "SOURCE_FRICTION", "SOURCE_SUPERVISOR",
                         "SOURCE_OPERATOR", "SOURCE_RECORDER",   "SOURCE_MONITOR",  "SOURCE_TWIN"};
  return {{"tick", h.tick},
          {"sample_time_ns", h.sample_time_ns},
          {"source", names.at(h.source)},
          {"epoch", h.epoch}};
}
ordered_json expected(const msg::AxisReference& a) {
  return {{"position", a.position}, {"speed", a.speed}, {"acceleration", a.acceleration}};
}
template <class T, std::size_t N>
ordered_json expected(const T (&values)[N]) {
  ordered_json list = ordered_json::array();
  for (const T& value : values) {
    if constexpr (std::is_same_v<T, msg::AxisReference>)
      list.push_back(expected(value));
    else
      list.push_back(value);
  }
  return list;
}

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
  q.duration_s = f.real();
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
                                                                 {"duration_s", q.duration_s},
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

}  // namespace
}  // namespace crane::recording
