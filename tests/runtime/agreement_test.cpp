// Detection of a process with another rig file or controller, and propagation of this difference to the
// supervisor.
#include "crane/runtime/agreement.hpp"

#include <gtest/gtest.h>

namespace crane::runtime {
namespace {

constexpr std::uint32_t kOwn = 4711, kOther = 815;

msg::State state_with(std::uint32_t configuration) {
  msg::State state{};
  state.header.source = crane_SOURCE_PLANT;
  state.configuration = configuration;
  return state;
}
msg::Contribution contribution_with(std::uint32_t configuration) {
  msg::Contribution contribution{};
  contribution.header.source = crane_SOURCE_TRACKING;
  contribution.configuration = configuration;
  return contribution;
}

class AgreementOfTwoInputs : public testing::Test {
 protected:
  void note(const msg::State& state, const msg::Contribution& contribution) {
    agreement_.note(0, &state);
    agreement_.note(1, &contribution);
  }
  Agreement<2> agreement_{kOwn};
};

TEST_F(AgreementOfTwoInputs, StatesTheOwnConfigurationWhileAllInputsHaveIt) {
  note(state_with(kOwn), contribution_with(kOwn));
  EXPECT_EQ(agreement_.configuration(), kOwn);
  EXPECT_FALSE(agreement_.other());
}

TEST_F(AgreementOfTwoInputs, StatesZeroAndNamesTheProcessWithAnotherConfiguration) {
  note(state_with(kOwn), contribution_with(kOther));
  EXPECT_EQ(agreement_.configuration(), 0U);
  EXPECT_EQ(agreement_.other(), crane_SOURCE_TRACKING);
}

TEST_F(AgreementOfTwoInputs, PassesOnADifferenceThatAnInputStates) {
  note(state_with(kOwn), contribution_with(0));
  EXPECT_EQ(agreement_.configuration(), 0U);
  EXPECT_FALSE(agreement_.other()) << "the process that found the difference names the other process";
}

TEST_F(AgreementOfTwoInputs, KeepsADifferenceWhileTheInputIsMissing) {
  note(state_with(kOwn), contribution_with(kOther));
  agreement_.note(1, static_cast<const msg::Contribution*>(nullptr));
  EXPECT_EQ(agreement_.configuration(), 0U);
  note(state_with(kOwn), contribution_with(kOwn));
  EXPECT_EQ(agreement_.configuration(), kOwn);
}

TEST_F(AgreementOfTwoInputs, IgnoresATopicThatStatesNoConfiguration) {
  const msg::SupervisorStatus status{};
  const auto state = state_with(kOwn);
  agreement_.note(0, &state);
  agreement_.note(1, &status);
  EXPECT_EQ(agreement_.configuration(), kOwn);
}

}  // namespace
}  // namespace crane::runtime
