// A process that writes is reachable from other hosts only with keys, unless the user permits it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/runtime/process.hpp"
#include "crane/security/keys.hpp"

namespace crane::runtime {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const BusOptions& options, crane_Source source) {
  try {
    (void)bus_options(options, "test", source, 1);
  } catch (const configuration::ConfigurationError& error) {
    return error.what();
  }
  return "accepted";
}
BusOptions reachable() {
  BusOptions options;
  options.interfaces = {"127.0.0.1", "192.0.2.7"};
  return options;
}

TEST(OpenNetwork, IsRefusedToWritingProgramsWithTheRemedy) {
  for (const auto source :
       {crane_SOURCE_SUPERVISOR, crane_SOURCE_BRIDGE, crane_SOURCE_OPERATOR, crane_SOURCE_RECORDER})
    EXPECT_THAT(refusal(reachable(), source),
                AllOf(HasSubstr("--interface 192.0.2.7"), HasSubstr("crane keys make"), HasSubstr("--secure"),
                      HasSubstr("--insecure")));
}

TEST(OpenNetwork, IsPermittedToProgramsThatOnlyRead) {
  EXPECT_EQ(refusal(reachable(), crane_SOURCE_MONITOR), "accepted");
}

TEST(OpenNetwork, IsPermittedWithInsecureAndReportedAsInsecure) {
  auto options = reachable();
  options.insecure = true;
  EXPECT_TRUE(is_insecure(bus_options(options, "test", crane_SOURCE_SUPERVISOR, 1)));
}

TEST(LoopBack, NeedsNoKeys) {
  BusOptions options;
  options.interfaces = {"127.0.0.1", "127.0.0.2"};
  EXPECT_FALSE(is_insecure(bus_options(options, "test", crane_SOURCE_SUPERVISOR, 1)));
}

TEST(SecureBus, GetsTheIdentityOfItsRoleAndVendor) {
  const recording::TemporaryDirectory directory;
  security::make(directory / "keys", security::valid_for(1));
  auto options = reachable();
  options.secure = (directory / "keys").string();
  options.vendor = "fastdds";
  const auto result = bus_options(options, "test", crane_SOURCE_PLANT, 1);
  ASSERT_TRUE(result.credentials);
  EXPECT_EQ(result.credentials->private_key, (directory / "keys/bridge/fastdds/key.pem").string());
  EXPECT_FALSE(is_insecure(result));
}

TEST(SecureBus, WithoutItsKeysIsRefusedWithEachFile) {
  auto options = reachable();
  options.secure = "/nowhere";
  EXPECT_THAT(refusal(options, crane_SOURCE_SUPERVISOR),
              AllOf(HasSubstr("/nowhere/supervisor/cyclone/key.pem"), HasSubstr("does not exist"),
                    HasSubstr("crane keys show")));
}

}  // namespace
}  // namespace crane::runtime
