#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "crane/bus/bus.hpp"

namespace crane::bus {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const Options& options) {
  try {
    const Bus bus{options};
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Options, DomainAboveAHundredIsRefusedByBothVendors) {
  for (const Vendor vendor : {Vendor::cyclone, Vendor::fastdds})
    EXPECT_THAT(refusal({.vendor = vendor, .domain = 101}),
                AllOf(HasSubstr("domain = 101"), HasSubstr("0..100")));
}

TEST(Options, AnUnknownInterfaceIsRefusedWithTheInterfacesOfThisHost) {
  EXPECT_THAT(refusal({.domain = 40, .interfaces = {"203.0.113.9"}}),
              AllOf(HasSubstr("203.0.113.9 is not an address of this host"), HasSubstr("127.0.0.1")));
}

TEST(Options, APeerWithoutAnAddressIsRefused) {
  EXPECT_THAT(refusal({.domain = 40, .peers = {"256.1.1.1"}}), HasSubstr("256.1.1.1"));
}

TEST(Options, ADiscoveryServerIsUsedByFastDdsOnlyAndInsteadOfPeers) {
  EXPECT_THAT(refusal({.domain = 40, .peers = {"127.0.0.1"}, .discovery_server = "127.0.0.1"}),
              AllOf(HasSubstr("Cyclone DDS cannot use the Discovery Server"), HasSubstr("--dds fastdds"),
                    HasSubstr("either a server or peers")));
  EXPECT_THAT(refusal({.vendor = Vendor::fastdds,
                       .domain = 40,
                       .discovery_server = "127.0.0.1",
                       .credentials = Credentials{}}),
              HasSubstr("discovery_server: the server has no keys"));
  for (const char* wrong : {"256.1.1.1", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:one", ":11811"})
    EXPECT_THAT(refusal({.vendor = Vendor::fastdds, .domain = 40, .discovery_server = wrong}),
                HasSubstr("discovery_server: '" + std::string{wrong} + "' must be HOST or HOST:PORT"));
}

TEST(Options, AllProblemsAreReportedAtOnce) {
  EXPECT_THAT(
      refusal({.domain = 200, .crane = "", .interfaces = {}}),
      AllOf(HasSubstr("domain = 200"), HasSubstr("crane is empty"), HasSubstr("interfaces is empty")));
}

TEST(Options, AMemoryBusNeedsANetwork) {
  EXPECT_THAT(refusal({.vendor = Vendor::memory}), HasSubstr("make_memory_network()"));
}

TEST(Vendor, HasANameThatCanBeReadBack) {
  for (const Vendor vendor : {Vendor::cyclone, Vendor::fastdds, Vendor::memory})
    EXPECT_EQ(vendor_from_string(to_string(vendor)), vendor);
  EXPECT_EQ(vendor_from_string("opendds"), std::nullopt);
}

}  // namespace
}  // namespace crane::bus
