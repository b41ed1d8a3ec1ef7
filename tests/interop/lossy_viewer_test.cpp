// A viewer on another host, behind a link that loses 20 % of the frames and delays the others by 5 ms: the
// state of the crane arrives, and the loop does not change.
#include <gmock/gmock.h>

#include <future>
#include <optional>

#include "lossy_link.hpp"

namespace crane::stack {
namespace {

using hosts::Answer;
using hosts::LossyLink;
using hosts::Running;
using hosts::TwoHosts;
using testing::HasSubstr;

constexpr LossyLink::Properties kLink{.lost_share = 0.2, .delay = std::chrono::milliseconds{5}, .seed = 20};

class LossyViewer : public testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts_.ok()) << "cannot make network namespaces with `ip netns`";
    link_.emplace(hosts_, kLink);
    RecordProperty("seed", static_cast<int>(kLink.seed));
  }
  void TearDown() override {
    if (!link_) return;
    std::cout << link_->lost() << " of " << link_->frames() << " frames lost, seed " << kLink.seed << '\n';
    EXPECT_GT(link_->lost(), link_->frames() / 10);
  }
  static std::string at(const char* address) { return std::string{" --domain 89 --interface "} + address; }
  [[nodiscard]] Answer near(const std::string& command) const {
    return hosts_.on_near(command + at(LossyLink::kNear) + " --insecure");
  }
  /// Discovery takes longer than on a link without loss.
  [[nodiscard]] Answer viewer(const std::string& command) const {
    Answer answer;
    for (int i = 0; i < 10 && answer.exit_code != 0; ++i)
      answer = hosts_.on_far(command + at(LossyLink::kFar));
    return answer;
  }
  TwoHosts hosts_;
  std::optional<LossyLink> link_;
};

TEST_F(LossyViewer, ReceivesTheStateOfAnArmedCraneThatStaysArmed) {
  const Running stack{
      hosts_.near(),
      {"up", "--no-black-box", "--domain", "89", "--interface", LossyLink::kNear, "--insecure"}};
  for (const char* request : {"reset", "arm"}) {
    Answer answer;
    for (int i = 0; i < 20 && answer.exit_code != 0; ++i) answer = near(request);
    ASSERT_EQ(answer.exit_code, 0) << request << ": " << answer.errors;
  }
  for (const std::string topic : {"crane/state", "crane/reference", "crane/command", "crane/supervisor"}) {
    const auto echo = viewer("topic echo " + topic + " --count 300 --json");
    ASSERT_EQ(echo.exit_code, 0) << topic << ": " << echo.errors;
    EXPECT_EQ(std::ranges::count(echo.output, '\n'), 300) << topic;
  }
  const auto seen = viewer("status --json --timeout 30");
  ASSERT_EQ(seen.exit_code, 0) << seen.errors;
  EXPECT_THAT(seen.output, HasSubstr("\"unheard\": []"));
  const auto status = near("status --json");
  ASSERT_EQ(status.exit_code, 0) << status.errors;
  EXPECT_THAT(status.output, HasSubstr("\"STATE_HOLD\"")) << "the crane was not stopped";
}

TEST_F(LossyViewer, DoesNotChangeARunInLockstep) {
  const recording::TemporaryDirectory directory;
  const auto run = [&](const std::string& name) {
    const auto out = (directory / name).string();
    const auto answer = near("run maneuver_1 --no-picture --out " + out);
    EXPECT_EQ(answer.exit_code, 0) << answer.errors;
    return recording::contents_of(out + "/run.csv");
  };
  const auto alone = run("alone");
  ASSERT_GT(alone.size(), 100'000U);
  auto watching = std::async(std::launch::async, [this] {
    return viewer("topic echo crane/state --count 50 --json --crane 'crane_run_*'");
  });
  do EXPECT_EQ(run("watched"), alone);
  while (watching.wait_for(std::chrono::seconds{0}) != std::future_status::ready && !HasFailure());
  const auto seen = watching.get();
  ASSERT_EQ(seen.exit_code, 0) << seen.errors;
  EXPECT_EQ(std::ranges::count(seen.output, '\n'), 50);
}

}  // namespace
}  // namespace crane::stack
