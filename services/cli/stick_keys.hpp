#pragma once
/// Keys of a terminal as a stick. A terminal reports no release of a key: a key acts for a limited time,
/// which each repetition renews. Time is an argument.
#include <array>
#include <string>
#include <string_view>

namespace crane::cli {

class StickKeys {
 public:
  static constexpr double kFirst_s =
      0.6;  ///< after the first press: longer than the delay of a key's repetition
  static constexpr double kRepeat_s = 0.15;  ///< after a repetition
  static constexpr double kMicro = 0.1;      ///< deflection with shift, and while micro-speed is on

  /// Takes bytes of the terminal; a sequence may be split between calls.
  void take(std::string_view bytes, double now_s);
  /// Deflection of trolley, slew and hoist.
  [[nodiscard]] std::array<double, 3> deflection(double now_s) const;
  /// Time of the last key that deflects the stick; negative: none yet, or released by the space bar.
  [[nodiscard]] double last_s() const { return last_s_; }
  [[nodiscard]] bool quits() const { return quits_; }
  [[nodiscard]] bool micro() const { return micro_; }

 private:
  struct Key {
    double share = 0, until_s = -1;
  };
  void press(std::size_t axis, double share, double now_s);
  bool take_sequence(double now_s);

  std::string pending_;
  std::array<Key, 3> key_{};
  double last_s_ = -1;
  bool quits_ = false, micro_ = false;
};

}  // namespace crane::cli
