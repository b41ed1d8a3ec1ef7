#include "dashboard/access.hpp"

#include <gtest/gtest.h>

namespace crane::dashboard {
namespace {

const AccessRules kRules{.token = "0123456789abcdef",
                         .host_names = {"crane.lab"},
                         .other_origins = {"https://app.foxglove.dev"},
                         .read_only = false};
const Visitor kAtTheRig{
    .loop_back = true, .host = "127.0.0.1:8765", .origin = "", .fetched = "", .token = "0123456789abcdef"};

TEST(Access, TheComputerOfTheRigReadsAndOperatesWithoutAToken) {
  auto rules = kRules;
  rules.token = "";
  auto visitor = kAtTheRig;
  visitor.token = "";
  EXPECT_TRUE(may_look(rules, visitor));
  EXPECT_EQ(why_not_operate(rules, visitor), "");
}

TEST(Access, ATokenIsAlsoRequiredAtTheRigExceptForAStop) {
  auto visitor = kAtTheRig;
  EXPECT_EQ(why_not_operate(kRules, visitor), "");
  for (const auto* token : {"", "0123456789abcdeg"}) {
    visitor.token = token;
    EXPECT_NE(why_not_operate(kRules, visitor), "");
    EXPECT_EQ(why_not_stop(kRules, visitor), "");
    EXPECT_EQ(sends_wrong_token(kRules, visitor), *token != '\0');
  }
  visitor.loop_back = false;
  EXPECT_NE(why_not_stop(kRules, visitor), "");
}

TEST(Access, APageOfAnotherOriginCannotStopTheCrane) {
  auto visitor = kAtTheRig;
  visitor.origin = "http://evil.example";
  EXPECT_NE(why_not_stop(kRules, visitor), "");
}

TEST(Access, AForeignNameForThisComputerIsRefusedAlsoWithAMatchingOrigin) {
  auto visitor = kAtTheRig;
  visitor.host = "evil.example:8765";
  visitor.origin = "http://evil.example:8765";
  EXPECT_FALSE(may_look(kRules, visitor));
  EXPECT_NE(why_not_operate(kRules, visitor), "");
}

TEST(Access, AHostIsAnAddressOrANameAndAtMostAPort) {
  auto visitor = kAtTheRig;
  for (const auto* host : {"127.0.0.1", "127.0.0.1:8765", "[::1]", "[::1]:8765", "localhost:1"}) {
    visitor.host = host;
    EXPECT_TRUE(host_allowed(kRules, visitor)) << host;
  }
  for (const auto* host : {"127.0.0.1:8765@evil.example", "127.0.0.1@evil.example",
                           "127.0.0.1:8765:evil.example", "[::1]evil.example", "[::1", ":8765", ""}) {
    visitor.host = host;
    EXPECT_FALSE(host_allowed(kRules, visitor)) << host;
  }
}

TEST(Access, APageOfAnotherOriginNeitherReadsNorOperates) {
  auto visitor = kAtTheRig;
  visitor.origin = "http://evil.example";
  EXPECT_FALSE(may_look(kRules, visitor));
  EXPECT_NE(why_not_operate(kRules, visitor), "");
  visitor.origin = "null";
  EXPECT_FALSE(may_look(kRules, visitor));
}

TEST(Access, AnOriginThatIsNamedReadsAndDoesNotOperate) {
  auto visitor = kAtTheRig;
  visitor.origin = "https://app.foxglove.dev";
  EXPECT_TRUE(may_look(kRules, visitor));
  EXPECT_NE(why_not_operate(kRules, visitor), "");
}

TEST(Access, ARequestThatABrowserCallsCrossSiteDoesNotOperate) {
  auto visitor = kAtTheRig;
  visitor.fetched = "cross-site";
  EXPECT_NE(why_not_operate(kRules, visitor), "");
  visitor.fetched = "same-origin";
  EXPECT_EQ(why_not_operate(kRules, visitor), "");
}

TEST(Access, AddressesLocalhostAndNamedHostsAreThisComputer) {
  for (const auto* host :
       {"127.0.0.1:8765", "127.0.0.1", "localhost:8765", "[::1]:8765", "192.0.2.7:80", "crane.lab:8765"}) {
    auto visitor = kAtTheRig;
    visitor.host = host;
    EXPECT_TRUE(host_allowed(kRules, visitor)) << host;
  }
  for (const auto* host : {"", ":", "[", "[::1", "[::1]evil", "[::1]evil:8765", "localhost.evil.example",
                           "127.0.0.1.evil.example:8765", "crane.lab.evil:1"}) {
    auto visitor = kAtTheRig;
    visitor.host = host;
    EXPECT_FALSE(host_allowed(kRules, visitor)) << host;
  }
}

TEST(Access, FromAnotherComputerTheTokenDecides) {
  Visitor visitor{.loop_back = false, .host = "192.0.2.7:8765", .origin = "", .fetched = "", .token = ""};
  EXPECT_TRUE(may_look(kRules, visitor));
  EXPECT_NE(why_not_operate(kRules, visitor), "");
  visitor.token = "0123456789abcdeg";
  EXPECT_NE(why_not_operate(kRules, visitor), "");
  visitor.token = "0123456789abcdef";
  EXPECT_EQ(why_not_operate(kRules, visitor), "");
}

TEST(Access, WithoutAConfiguredTokenNoRequestOfAnotherComputerOperatesNotEvenWithAnEmptyToken) {
  auto rules = kRules;
  rules.token = "";
  const Visitor visitor{
      .loop_back = false, .host = "192.0.2.7:8765", .origin = "", .fetched = "", .token = ""};
  EXPECT_NE(why_not_operate(rules, visitor), "");
}

TEST(Access, ReadOnlyHoldsAtTheRigToo) {
  auto rules = kRules;
  rules.read_only = true;
  EXPECT_NE(why_not_operate(rules, kAtTheRig), "");
}

TEST(Access, TokensAreRandomAndComparedWhole) {
  EXPECT_NE(random_token(), random_token());
  EXPECT_EQ(random_token().size(), 32U);
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_FALSE(equal_in_constant_time("abc", "abcd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
}

}  // namespace
}  // namespace crane::dashboard
