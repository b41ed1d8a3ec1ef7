#pragma once
/// Keys of a terminal as a stick. A terminal reports no release of a key: a key acts for a limited time,
/// which each repetition renews. Time is an argument.
///
/// A terminal does not report when a key was pressed either. The keys that a *pass* reads may have been
/// pressed immediately after the previous pass, or earlier if they waited on a connection. A key that can be
/// old must not move the crane.
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/inching.hpp"

namespace crane::cli {

class StickKeys {
 public:
  /// Time for which a key acts after its press: longer than the delay until the keyboard repeats the key.
  static constexpr double kFirst_s = 0.6;
  static constexpr double kRepeat_s = 0.15;  ///< time for which a key acts after a repetition
  /// Largest number of bytes of a pass whose keys can be new. A keyboard that repeats a key of 6 bytes (shift
  /// and arrow) 30 times per second sends 6 bytes in a pass of 20 ms and 54 bytes in a pass of 0.3 s.
  static constexpr std::size_t kMostNewBytes = 64;

  /// Modes at the start; the keys m and i change them.
  explicit StickKeys(bool micro = false, bool inching = false) : micro_{micro}, inching_{inching} {}

  /// Takes all bytes that wait in the terminal; call in every pass, also without bytes. The keys
  /// count from the previous pass on. A pass is a backlog if it is the first pass, if it comes more
  /// than kFirst_s after the previous pass, or if it has more than kMostNewBytes. In three cases,
  /// arrow and page keys have no effect and r only releases the stick: in a backlog, for kRepeat_s
  /// after a backlog with keys, and in a pass that contains space or q.
  void take_pass(std::string_view bytes, double now_s);
  /// Takes bytes that arrived at `now_s`; a sequence may be split between calls.
  void take(std::string_view bytes, double now_s);
  /// Deflection of trolley, slew and hoist; 0 while inching is on.
  [[nodiscard]] std::array<double, 3> deflection(double now_s) const;
  /// Time from which the last accepted arrow or page key acts (the time of the previous pass); negative: no
  /// such key yet, or the space bar, i or r released the stick.
  [[nodiscard]] double last_s() const { return last_s_; }
  [[nodiscard]] bool quits() const { return quits_; }
  [[nodiscard]] bool micro() const { return micro_; }
  [[nodiscard]] bool inching() const { return inching_; }

  /// Takes the step that a key press requested while inching was on. A key that is held down requests one
  /// step only; the same key requests the next step when it was released for kFirst_s.
  [[nodiscard]] std::optional<InchingStep> take_step() { return std::exchange(step_, std::nullopt); }
  /// True once after the key r. The key also releases the stick.
  [[nodiscard]] bool take_return() { return std::exchange(returns_, false); }
  /// True once after each press of the space bar.
  [[nodiscard]] bool take_stop() { return std::exchange(released_, false); }

 private:
  struct Key {
    double share = 0, until_s = -1;
  };
  void press(std::size_t axis, double share, double now_s);
  void release();
  void take_letter(char letter);
  bool take_sequence(double now_s);

  std::string pending_;
  std::optional<double> previous_pass_s_;
  double backlog_until_s_ = -1;  ///< before this time, keys can belong to an old backlog
  bool keys_move_ = true;        ///< false: arrow keys, page keys and r have no effect
  std::array<Key, 3> key_{};
  double last_s_ = -1;
  std::optional<InchingStep> step_;
  bool micro_, inching_;
  bool quits_ = false, returns_ = false, released_ = false;
};

}  // namespace crane::cli
