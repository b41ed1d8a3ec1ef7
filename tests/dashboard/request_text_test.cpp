#include "dashboard/request_text.hpp"

#include <gtest/gtest.h>

#include <random>

namespace crane::dashboard {
namespace {

TEST(RequestText, AMoveNamesTheAxesThatItMoves) {
  const auto wish = wish_of_text(R"({"kind":"move","trolley_m":1.05,"slew_rad":-0.5})");
  EXPECT_EQ(wish.kind, crane_REQUEST_MOVE);
  EXPECT_EQ(wish.selected, (std::array{true, true, false}));
  EXPECT_EQ(wish.target, (std::array{1.05, -0.5, 0.0}));
}

TEST(RequestText, HomeAndResetHaveTheirFields) {
  EXPECT_EQ(wish_of_text(R"({"kind":"home","axis":"hoist"})").selected, (std::array{false, false, true}));
  EXPECT_EQ(wish_of_text(R"({"kind":"reset"})").selected, (std::array{false, false, false}));
  EXPECT_EQ(wish_of_text(R"({"kind":"reset","confirm_positions":true})").selected,
            (std::array{true, true, true}));
}

TEST(RequestText, OnlyStopsNeedNoSeat) {
  for (const auto* kind : {"reset", "arm", "disarm", "stop", "estop"}) {
    const auto wish = wish_of_text(R"({"kind":")" + std::string{kind} + "\"}");
    EXPECT_EQ(is_stop(wish.kind), std::string_view{kind}.ends_with("stop")) << kind;
  }
}

TEST(RequestText, WhatIsNoRequestOfAnOperatorIsRefused) {
  for (const auto* text :
       {"", "[]", "{}", R"({"kind":"advance"})", R"({"kind":"kick"})", R"({"kind":"follow"})",
        R"({"kind":1})", R"({"kind":"move"})", R"({"kind":"move","trolley_m":"1"})",
        R"({"kind":"move","trolley_m":1e999})", R"({"kind":"move","trolley":1})",
        R"({"kind":"move","trolley_m":null})", R"({"kind":"arm","trolley_m":1})", R"({"kind":"home"})",
        R"({"kind":"home","axis":"jib"})", R"({"kind":"reset","confirm_positions":1})",
        R"({"kind":"move","trolley_m":[[[1]]]})"})
    EXPECT_THROW((void)wish_of_text(text), BadRequest) << text;
}

TEST(RequestText, MutatedRequestsEitherParseOrAreRefused) {
  const std::string seed = R"({"kind":"move","trolley_m":1.05,"slew_rad":-0.5,"hoist_m":1})";
  std::mt19937 random{11};
  std::uniform_int_distribution<std::size_t> where{0, seed.size() - 1};
  std::uniform_int_distribution<int> what{0, 255};
  for (int i = 0; i < 20'000; ++i) {
    auto text = seed;
    for (int n = 0; n <= i % 3; ++n) text[where(random)] = static_cast<char>(what(random));
    try {
      for (const double target : wish_of_text(text).target) EXPECT_TRUE(std::isfinite(target)) << text;
    } catch (const BadRequest&) {
    }
  }
}

}  // namespace
}  // namespace crane::dashboard
