#pragma once
/// Session of an operator's stick: decides which samples of crane/jog act. Time and tick are arguments.
///
/// An accepted REQUEST_JOG begins a session. The first sample with the client, the request id and the
/// start-up number of the request binds the session to its DDS writer, which the middleware assigns. The
/// samples of every other writer have no effect. The stick counts as released when `engaged` is false, a
/// deflection of the newest sample is not in [-1, 1], or the newest sample is older than kSilence_s.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bus/bus.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

class JogSession {
 public:
  static constexpr double kSilence_s = 0.1;
  /// From the acceptance until the first sample must have arrived.
  static constexpr double kFirst_s = 0.5;

  enum class Verdict : std::uint8_t {
    acts,      ///< the sample is the present deflection
    released,  ///< the sample is from the operator of the session, and releases the stick: see above
    ended,     ///< the sample is from the operator of the last session, which has ended
    stranger   ///< the sample is from another writer, or there has been no session
  };

  explicit JogSession(double period_s) : period_s_{period_s} {}
  void begin(const msg::Request& request, double now_s);
  void end() { open_ = false; }
  Verdict take(const msg::Jog& sample, const bus::WriterId& writer, std::uint64_t tick, double now_s);

  /// Deflection of the selected axes; 0 while the stick is released or silent.
  [[nodiscard]] std::array<double, 3> deflection(double now_s) const;
  /// True while the stick is engaged, and until the first sample is overdue.
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
