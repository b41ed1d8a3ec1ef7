#include <cmath>
#include <optional>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PositionDrift final : public Term {
 public:
  explicit PositionDrift(const TermSetting& s) : slew_(s.axis == "slew"), rate_(s.parameters.at("rate")) {}

  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    double& position = slew_ ? measured.slew_rad : measured.trolley_m;
    travelled_ += std::abs(position - last_.value_or(position));
    last_ = position;
    position += rate_ * travelled_;
  }

 private:
  bool slew_;
  double rate_;
  std::optional<double> last_;  // true position one tick ago
  double travelled_ = 0;
};

}  // namespace

TermKind position_drift() {
  return {.name = "position_drift",
          .equation = "p_measured = p + r s, s the distance travelled since the start, both ways counted",
          .source = "a friction wheel that slips or an encoder that loses counts while moving",
          .acts_on = ActsOn::sensor,
          .axes = {"trolley", "slew"},
          .parameters = {{"rate", "m/m or rad/rad", 0, -0.5, 0.5, "r"}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<PositionDrift>(s);
          }};
}

}  // namespace crane::plant
