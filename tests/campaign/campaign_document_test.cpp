// docs/campaign.md shows the hazards, moments and invariants of the code.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "campaign/report.hpp"

namespace crane::campaign {
namespace {

std::string document() {
  std::ifstream in{CRANE_SOURCE_DIRECTORY "/docs/campaign.md"};
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(CampaignDocument, ShowsTheHazardsOfTheCampaign) {
  const std::string text = document(), begin = "<!-- crane campaign --list -->\n";
  const auto from = text.find(begin);
  ASSERT_NE(from, std::string::npos);
  const auto shown = text.substr(from + begin.size(), text.find("<!-- end -->", from) - from - begin.size());
  EXPECT_EQ(shown, hazard_table()) << "put the table of `crane campaign --list` there";
}

TEST(CampaignDocument, DescribesEveryMomentAndEveryInvariant) {
  const std::string text = document();
  for (std::size_t m = 0; m < kMoments; ++m) {
    const std::string row = "\n| `" + std::string{name_of(static_cast<Moment>(m))} + "` | ";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
  for (std::size_t i = 0; i < kInvariants; ++i) {
    const std::string row = "\n| I" + std::to_string(i + 1) + " | ";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace crane::campaign
