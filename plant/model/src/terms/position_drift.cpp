#include <cmath>
#include <optional>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PositionDrift final : public Term {
 public:
  explicit PositionDrift(const TermSetting& s)
      : slew_(s.axis == "slew"), rate_(s.parameters.at("rate")), jump_(s.parameters.at("jump")) {}

  [[nodiscard]] bool remembers_motion() const noexcept override { return true; }
  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    double& position = slew_ ? measured.slew_rad : measured.trolley_m;
    travelled_ += std::abs(position - last_.value_or(position));
    last_ = position;
    position += drifted();
  }

 private:
  [[nodiscard]] double drifted() const noexcept {
    const double smoothly = rate_ * travelled_;
    return jump_ > 0 ? jump_ * std::trunc(smoothly / jump_) : smoothly;
  }

  bool slew_;
  double rate_, jump_;
  std::optional<double> last_;  // true position at the last tick
  double travelled_ = 0;
};

}  // namespace

TermKind position_drift() {
  return {
      .name = "position_drift",
      .equation =
          "p_measured = p + r s, s the path length since the start; r s is rounded towards 0 to multiples "
          "of j when j > 0",
      .effect = "a friction wheel slips, or an encoder loses counts while the axis moves",
      .acts_on = ActsOn::sensor,
      .axes = {"trolley", "slew"},
      .parameters = {{"rate", "m/m or rad/rad", 0, -0.5, 0.5, "r, error / distance travelled"},
                     {"jump", "m or rad", 0, 0, 1, "j, size of one loss; 0: continuous loss"}},
      .example = {"position_drift", "trolley", {{"rate", 0.01}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<PositionDrift>(s);
      }};
}

}  // namespace crane::plant
