// For every wrong wiring of the emulated rig, the self-test reports exactly this fault.
#include <cmath>
#include <functional>

#include "bench.hpp"
#include "crane/bring_up/jog.hpp"

namespace crane::bring_up::test {
namespace {

using Names = std::vector<std::string>;

Names found_on(Bench& bench) {
  Names names;
  for (const auto& finding : judge(bench.stated(), gather(bench.session(), {}))) {
    names.push_back(std::string{name_of(finding.fault)} + ": " + finding.subject);
    EXPECT_EQ(finding.text.find('\n'), std::string::npos);
    EXPECT_GT(finding.text.size(), 40U) << "a line says what to do";
  }
  return names;
}

/// The rig file describes the crane; its wiring differs.
struct Miswiring {
  const char* name;
  Names expected;
  std::function<void(configuration::Rig&)> wire = [](configuration::Rig&) {};
  StuckLines stuck{};
  friend std::ostream& operator<<(std::ostream& out, const Miswiring& wrong) { return out << wrong.name; }
};

class Wrong : public testing::TestWithParam<Miswiring> {};

TEST_P(Wrong, IsReportedAsTheOnlyFault) {
  auto wired = tower();
  GetParam().wire(wired);
  Bench bench{tower(), wired, GetParam().stuck};
  EXPECT_EQ(found_on(bench), GetParam().expected);
  bench.end_session();
  EXPECT_EQ(bench.rig().drive_v(), (std::array<double, kDrives>{}));
}

constexpr int kNowhere = 7;  // an unused channel

std::uint16_t bit(int line) { return static_cast<std::uint16_t>(1U << static_cast<unsigned>(line % 16)); }

std::vector<Miswiring> all() {
  std::vector<Miswiring> all{{"Nothing", {}}};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const std::string axis{coordinate_name(i)};
    const bool has_load = axis != "hoist";
    all.push_back({"DriveSign",
                   {(has_load ? "drive_sign: " : "drive_or_encoder_sign: ") + axis},
                   [i](auto& rig) { rig.drives[i].sign = -1; }});
    all.push_back({"EncoderSign",
                   {(has_load ? "encoder_sign: " : "drive_or_encoder_sign: ") + axis},
                   [i](auto& rig) { rig.encoders[i].sign = -1; }});
    all.push_back({"DeadEncoder",
                   {(has_load ? "encoder_dead: " : "drive_or_encoder_dead: ") + axis},
                   [i](auto& rig) { rig.encoders[i].channel = kNowhere; }});
    all.push_back({"DeadDrive",
                   {(has_load ? "drive_dead: " : "drive_or_encoder_dead: ") + axis},
                   [i](auto& rig) { rig.drives[i].dac_channel = kNowhere; }});
    const auto lines = tower().wiring.drives[i];
    all.push_back({"BrakeShut",
                   {"brake_stays_closed: " + axis},
                   [](auto&) {},
                   {.outputs_off = bit(lines.brake_release_output)}});
    all.push_back({"BrakeOpen",
                   {"brake_stays_open: " + axis},
                   [](auto&) {},
                   {.outputs_on = bit(lines.brake_release_output)}});
    all.push_back(
        {"BrakeSlips",
         {"brake_slips: " + axis},
         [](auto&) {},
         {.outputs_on = bit(lines.brake_release_output), .inputs_closed = bit(lines.brake_closed_input)}});
    all.push_back({"BrakeContact",
                   {"brake_contact: " + axis},
                   [](auto&) {},
                   {.inputs_open = bit(lines.brake_closed_input)}});
    all.push_back(
        {"BrakeSlow", {"brake_slow: " + axis}, [i](auto& rig) { rig.drives[i].brake_close_time_s = 0.5; }});
    all.push_back({"LimitWireBroken",
                   {"limit_open: " + axis},
                   [](auto&) {},
                   {.inputs_open = bit(lines.limit_high_input)}});
  }
  for (std::size_t i = 0; i < kCounters; ++i)
    for (std::size_t k = i + 1; k < kCounters; ++k)
      all.push_back(
          {"EncodersSwapped",
           {"encoders_swapped: " + std::string{coordinate_name(i)} + ", " + std::string{coordinate_name(k)}},
           [i, k](auto& rig) { std::swap(rig.encoders[i].channel, rig.encoders[k].channel); }});
  for (std::size_t i = 0; i < kDrives; ++i)
    for (std::size_t k = i + 1; k < kDrives; ++k) {
      const auto both = std::string{coordinate_name(i)} + ", " + std::string{coordinate_name(k)};
      all.push_back({"DrivesSwapped", {"drives_swapped: " + both}, [i, k](auto& rig) {
                       std::swap(rig.drives[i].dac_channel, rig.drives[k].dac_channel);
                     }});
      all.push_back({"BrakesSwapped", {"brakes_swapped: " + both}, [i, k](auto& rig) {
                       std::swap(rig.wiring.drives[i].brake_release_output,
                                 rig.wiring.drives[k].brake_release_output);
                     }});
    }
  for (std::size_t i = kDrives; i < kCounters; ++i) {
    const std::string swing{coordinate_name(i)};
    all.push_back({"SwingSign", {"swing_sign: " + swing}, [i](auto& rig) { rig.encoders[i].sign = -1; }});
    all.push_back(
        {"DeadSwing", {"swing_dead: " + swing}, [i](auto& rig) { rig.encoders[i].channel = kNowhere; }});
  }
  const auto wiring = tower().wiring;
  all.push_back({"RelayLate", {"relay_stuck: relay"}, [](auto& rig) { rig.wiring.relay_timeout_s = 1; }});
  all.push_back({"RelayWelded",
                 {"relay_stuck: relay"},
                 [](auto&) {},
                 {.inputs_closed = bit(wiring.relay_closed_input)}});
  all.push_back({"WatchdogWireBroken",
                 {"relay_dead: relay"},
                 [](auto&) {},
                 {.outputs_off = bit(wiring.watchdog_output)}});
  all.push_back({"EmergencyStop", {"estop: estop"}, [](auto&) {}, {.inputs_open = bit(wiring.estop_input)}});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Wirings, Wrong, testing::ValuesIn(all()), [](const auto& test) {
  std::string name = test.param.name;
  for (const auto& expected : test.param.expected)
    for (const char c : expected.substr(expected.find(':')))
      if (std::isalpha(static_cast<unsigned char>(c))) name += c;
  return name;
});

TEST(Selftest, KeepsEachAxisWithinTheRequiredTravel) {
  Bench bench{tower(), tower()};
  const auto evidence = gather(bench.session(), {});
  const auto& truth = bench.rig().crane().truth();
  EXPECT_LT(std::abs(truth.trolley_m - bench.stated().start.position[0]), 0.1);
  EXPECT_LT(std::abs(truth.slew_rad), 0.2);
  EXPECT_LT(std::abs(truth.cable_m - bench.stated().start.position[2]), 0.1);
  for (const auto& axis : evidence.axis) EXPECT_TRUE(axis.pushed);
}

TEST(Selftest, FindsTheFaultsAlsoWithASwingingLoad) {
  auto wired = tower();
  wired.start.swing_radial_rad = 0.03;
  wired.start.swing_tangential_rad = -0.02;
  Bench bench{tower(), wired};
  EXPECT_EQ(found_on(bench), Names{});
}

TEST(Selftest, TestsARigOfASingleAxis) {
  auto rig = configuration::load_rig(CRANE_RIGS "/drive_axis.toml");
  rig.board = "emulated";
  Bench right{rig, rig};
  EXPECT_EQ(found_on(right), Names{});
  auto wired = rig;
  for (auto& encoder : wired.encoders) encoder.sign = -1;
  Bench wrong{rig, wired};
  EXPECT_EQ(found_on(wrong).size(), 1U);
}

/// The rig is safe after an interruption at any tick.
TEST(Selftest, LeavesTheBoardSafeAfterAnInterruptionAtAnyTick) {
  for (int last = 1; last < 900; last += 37) {
    int ticks = 0;
    Bench bench{tower(), tower(), {}, {.interrupted = [&] { return ++ticks > last; }}};
    EXPECT_THROW(std::ignore = gather(bench.session(), {}), Ended) << last;
    bench.expect_safe();
  }
}

TEST(Selftest, EndsWhenTheEmergencyStopIsPressed) {
  int ticks = 0;
  Bench* pressed = nullptr;
  Bench bench{tower(), tower(), {}, {.interrupted = [&] {
                if (++ticks == 300) pressed->rig().crane().press_estop(true);
                return false;
              }}};
  pressed = &bench;
  EXPECT_THROW(std::ignore = gather(bench.session(), {}), Ended);
  bench.expect_safe();
}

TEST(Jog, MovesByTheRequestedDistanceAndEndsSafe) {
  for (const double drive_v : {2.0, -2.0}) {
    Bench bench{tower(), tower()};
    JogPlan plan{.axis = 0, .drive_v = drive_v, .distance = 0.05};
    plan.release[0] = true;
    const auto jog = run(bench.session(), plan);
    EXPECT_NEAR(jog.moved[0], std::copysign(0.05, drive_v), 0.02);
    EXPECT_NEAR(jog.moved[0], bench.rig().crane().truth().trolley_m - 0.3, 1e-5);
    EXPECT_TRUE(jog.closed_again);
    bench.session().make_safe();
    bench.expect_safe();
  }
}

TEST(Jog, EndsAtALimitSwitch) {
  auto rig = tower();
  rig.start.position[0] = rig.drives[0].high_limit - 0.01;
  Bench bench{rig, rig};
  JogPlan plan{.axis = 0, .drive_v = 2, .distance = 0.4};
  plan.release[0] = true;
  const auto jog = run(bench.session(), plan);
  EXPECT_TRUE(jog.limit);
  EXPECT_LT(bench.rig().crane().truth().trolley_m, rig.drives[0].high_limit + 0.02);
}

TEST(Jog, RefusesLargeMotions) {
  const double nan = std::nan("");
  EXPECT_TRUE(problems({.axis = 0, .drive_v = 2}, tower()).empty());
  for (const double drive_v : {0.0, 5.1, -6.0, nan})
    EXPECT_EQ(problems({.axis = 0, .drive_v = drive_v}, tower()).size(), 1U) << drive_v;
  for (const double distance : {0.0, -0.1, 0.6, nan})
    EXPECT_EQ(problems({.axis = 0, .drive_v = 2, .distance = distance}, tower()).size(), 1U) << distance;
  auto rig = tower();
  rig.drives[2].present = false;
  EXPECT_EQ(problems({.axis = 2, .drive_v = 2}, rig).size(), 1U);
}

}  // namespace
}  // namespace crane::bring_up::test
