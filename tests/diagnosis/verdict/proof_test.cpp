/// Confirmation of an extended model by the held-out runs.
#include "verdict/proof.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace crane::diagnosis {
namespace {

using Outcome = Proof::Outcome;

/// A cause that acts on the trolley.
class HeldOutProof : public testing::Test {
 protected:
  HeldOutProof() {
    candidate_.cause = "coulomb_friction";
    candidate_.axis = "trolley";
    candidate_.drive = true;
    effects_ = {{&candidate_, {0.1}}};
  }

  /// A clear gain in windows. Over whole runs, the trolley moves 1 m rms.
  /// @param base,extended rms error over whole runs, m
  static HeldOut followed(double base_m, double extended_m) {
    const std::string trolley = "trolley_position_m";
    HeldOut result;
    result.baseline_rms[trolley] = 0.007;
    result.extended_rms[trolley] = 0.002;
    result.whole_held_value_rms[trolley] = 1;
    result.whole_baseline_rms[trolley] = base_m;
    result.whole_extended_rms[trolley] = extended_m;
    result.whole_extended_motion[trolley] = 1;
    result.gain = 0.7;
    result.gain_ci95 = {0.5, 0.8};
    result.likelier = 1;
    return result;
  }

  [[nodiscard]] Outcome outcome_of(const HeldOut& held_out) const {
    return proof_of(held_out, effects_).outcome;
  }

  Candidate candidate_;
  Effects effects_;
};

TEST_F(HeldOutProof, FailsIfTheExtendedModelLosesAMotionThatTheBaseModelFollows) {
  EXPECT_EQ(outcome_of(followed(0.2, 0.9)), Outcome::refuted);
  EXPECT_EQ(outcome_of(followed(0.2, 0.6)), Outcome::proven);
}

TEST_F(HeldOutProof, IgnoresTheDriftOfABaseModelThatDoesNotFollowTheMotion) {
  EXPECT_EQ(outcome_of(followed(0.98, 2)), Outcome::proven);
  EXPECT_EQ(outcome_of(followed(0.98, 0.5)), Outcome::proven);
}

TEST_F(HeldOutProof, FailsIfTheExtendedModelStandsStill) {
  HeldOut still = followed(0.98, 1);
  still.whole_extended_motion["trolley_position_m"] = 0.05;
  EXPECT_EQ(outcome_of(still), Outcome::refuted);
}

TEST_F(HeldOutProof, FailsWithoutASignificantlyHigherLikelihood) {
  HeldOut unlikely = followed(0.2, 0.2);
  unlikely.likelier = 0.9;
  EXPECT_EQ(outcome_of(unlikely), Outcome::unlikely);
}

TEST_F(HeldOutProof, NamesNoConsequenceIfNoErrorDecreases) {
  HeldOut same = followed(0.2, 0.2);
  same.extended_rms = same.baseline_rms;
  EXPECT_EQ(outcome_of(same), Outcome::no_consequence);
}

}  // namespace
}  // namespace crane::diagnosis
