#pragma once
/// Session of an operator's stick: decides which samples of crane/jog act. Time and tick are arguments.
///
/// An accepted REQUEST_JOG begins a session. The first sample with the client, the request id and the
/// start-up number (header.epoch) of the request binds the session to its DDS writer. Samples of other
/// writers have no effect. The stick is released when `engaged` is false, when a deflection of the newest
/// sample is not in [-1, 1], when its tick is ahead of `tick` or older than kSilence_s, or when it arrived
/// more than kSilence_s ago.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bus/bus.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

class JogSession {
 public:
  /// Largest age of the newest sample.
  static constexpr double kSilence_s = 0.1;
  /// Longest time from the acceptance to the first sample.
  static constexpr double kFirst_s = 0.5;

  enum class Verdict : std::uint8_t {
    acts,      ///< the sample is the present deflection
    released,  ///< the sample belongs to the session and releases the stick (rules above)
    ended,     ///< the sample belongs to the last session, which has ended
    stranger   ///< the sample belongs to no session
  };

  explicit JogSession(double period_s) : period_s_{period_s} {}
  void begin(const msg::Request& request, double now_s);
  void end() { open_ = false; }
  Verdict take(const msg::Jog& sample, const bus::WriterId& writer, std::uint64_t tick, double now_s);

  /// Deflection of the selected axes; 0 while the stick is released or silent.
  [[nodiscard]] std::array<double, 3> deflection(double now_s) const;
  /// True while the stick is engaged, and for kFirst_s while no sample has arrived.
  [[nodiscard]] bool held(double now_s) const;
  [[nodiscard]] bool open() const { return open_; }

 private:
  [[nodiscard]] bool of_request(const msg::Jog& sample) const;
  [[nodiscard]] bool usable(const msg::Jog& sample, std::uint64_t tick) const;

  double period_s_;
  bool open_ = false;
  msg::Request request_{};
  std::optional<bus::WriterId> writer_;
  double begun_s_ = 0, heard_s_ = 0;
  bool engaged_ = false;
  std::array<double, 3> deflection_{};
};

}  // namespace crane::supervisor
