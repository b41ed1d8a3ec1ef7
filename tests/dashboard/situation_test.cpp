#include "dashboard/situation.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../observation/samples.hpp"

namespace crane::dashboard {
namespace {

using observation::kSecond_ns;
using observation::sample_of;
using observation::status_at;

nlohmann::ordered_json answer_of(const nlohmann::ordered_json& situation, const std::string& request) {
  for (const auto& answer : situation["answers"])
    if (answer["request"] == request) return answer;
  return nullptr;
}

TEST(Situation, StatesTheRefusalsOfALockedCraneWithReasons) {
  Situation situation;
  situation.add(*status_at(kSecond_ns, crane_STATE_LOCKED, crane_CAUSE_SWING_LIMIT));
  situation.add(*sample_of(topics::state, msg::State{}, kSecond_ns));
  const auto json = situation.json(kSecond_ns);
  EXPECT_EQ(json["state"], "LOCKED");
  EXPECT_EQ(json["cause"], "SWING_LIMIT");
  EXPECT_EQ(json["remedy"], "wait until the load swings less, then reset");
  EXPECT_TRUE(answer_of(json, "reset")["accepted"].get<bool>());
  EXPECT_EQ(answer_of(json, "arm")["reason"], "the crane is not READY: reset first");
  EXPECT_TRUE(answer_of(json, "estop")["accepted"].get<bool>());
}

/// A crane with a trolley, in `state`.
nlohmann::ordered_json situation_in(crane_SupervisorState state, bool brake_closed, bool homing) {
  Situation situation;
  msg::SupervisorStatus status{};
  status.state = state;
  status.volt_limit_v[0] = 10;
  status.high_limit[0] = 1;
  status.homing[0] = homing;
  msg::State measured{};
  measured.brake_closed[0] = brake_closed;
  measured.position_known[0] = !homing;
  situation.add(*sample_of(topics::supervisor, status, kSecond_ns));
  situation.add(*sample_of(topics::state, measured, kSecond_ns));
  return situation.json(kSecond_ns);
}

TEST(Situation, OfACraneThatHoldsOrMovesAcceptsAMove) {
  for (const auto state : {crane_STATE_HOLD, crane_STATE_RUN}) {
    const auto json = situation_in(state, false, false);
    EXPECT_TRUE(answer_of(json, "move")["accepted"].get<bool>()) << json.dump();
    EXPECT_EQ(answer_of(json, "arm")["reason"], "the crane is armed already");
  }
}

TEST(Situation, OfACraneWhoseBrakeClosedByItselfRefusesAMove) {
  EXPECT_FALSE(answer_of(situation_in(crane_STATE_HOLD, true, false), "move")["accepted"].get<bool>());
}

TEST(Situation, StatesThatAnAxisIsBeingHomed) {
  const auto json = situation_in(crane_STATE_RUN, false, true);
  EXPECT_EQ(answer_of(json, "move")["reason"], "an axis is being homed: wait for LOCKED, then reset and arm");
}

TEST(Situation, OfASilentSupervisorDoesNotKeepTheLastStatus) {
  Situation situation;
  EXPECT_FALSE(situation.json(0)["heard"].get<bool>());
  situation.add(*status_at(kSecond_ns, crane_STATE_HOLD, crane_CAUSE_NONE));
  EXPECT_EQ(situation.json(2 * kSecond_ns)["state"], "HOLD");
  const auto silent = situation.json(2 * kSecond_ns + 1);
  EXPECT_FALSE(silent["heard"].get<bool>());
  EXPECT_TRUE(silent["state"].is_null());
  EXPECT_FALSE(silent["remedy"].get<std::string>().empty());
}

TEST(Situation, NamesTheLatchOfTheBridgeWithItsRemedy) {
  Situation situation;
  msg::State state{};
  state.latch_reason = crane_LATCH_ENCODER_JUMP;
  situation.add(*status_at(kSecond_ns, crane_STATE_LOCKED, crane_CAUSE_BRIDGE_LATCHED));
  situation.add(*sample_of(topics::state, state, kSecond_ns));
  const auto latch = situation.json(kSecond_ns)["latch"];
  EXPECT_EQ(latch["reason"], "encoder_jump");
  EXPECT_TRUE(latch["final"].get<bool>());
  EXPECT_FALSE(latch["remedy"].get<std::string>().empty());
}

TEST(Situation, TextOfTheBusWithInvalidUtf8GivesValidJson) {
  Situation situation;
  msg::SupervisorStatus status{};
  status.state = crane_STATE_RUN;
  status.move.number = 1;
  runtime::assign(status.move.client, "\xff\xfe\"\\");
  situation.add(*sample_of(topics::supervisor, status, kSecond_ns));
  const auto parsed = nlohmann::json::parse(text_of(situation.json(kSecond_ns)));
  EXPECT_EQ(parsed["move"]["number"], 1);
}

}  // namespace
}  // namespace crane::dashboard
