#pragma once
/// Session of an operator's stick: decides which samples of crane/jog act. Time and tick are arguments.
///
/// An accepted REQUEST_JOG begins a session of the DDS participant that sent the request. The first sample of
/// this participant with the client, the request id and the start-up number (header.epoch) of the request
/// binds the session to the DDS writer of the sample. All other samples have no effect: a program that copies
/// client, request id and start-up number cannot take over the session by sending first.
///
/// A sample with `engaged` = false releases the stick. A deflection with a tick ahead of `tick`
/// counts as 0. During a silence of more than kSilence_s, the deflection is 0. The stick is faulty
/// after
///   (1) a deflection after a silence of more than kSilence_s while the stick was engaged,
///   (2) a sample with a tick older than kSilence_s,
///   (3) a deflection outside [-1, 1],
///   (4) a deflection of kLongest_s without a break.
/// A faulty stick counts as released until the operator releases it or returns it to zero: the motion does
/// not resume by itself.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bus/bus.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

/// Origin of a sample of crane/jog, as the middleware states it.
struct JogWriter {
  bus::ParticipantId participant = bus::kUnknownParticipant;
  bus::WriterId writer{};
};

class JogSession {
 public:
  /// Largest age of the newest sample.
  static constexpr double kSilence_s = 0.1;
  /// Longest time from the acceptance of the request to the first sample.
  static constexpr double kFirst_s = 0.5;
  /// Longest uninterrupted deflection: a stick that does not return to zero for longer is stuck, or nobody
  /// holds it. Also the longest time without a deflection: an engaged stick that is not moved must not keep
  /// the brakes open.
  static constexpr double kLongest_s = 60;

  enum class Verdict : std::uint8_t {
    acts,      ///< the sample contains the present deflection
    released,  ///< the sample belongs to the session and releases the stick (rules above)
    ended,     ///< the sample belongs to the last session, which has ended
    stranger   ///< the sample belongs neither to the open session nor to the last one
  };

  explicit JogSession(double period_s) : period_s_{period_s} {}
  /// @param sender  participant that sent the request; kUnknownParticipant: no sample has an effect
  void begin(const msg::Request& request, const bus::ParticipantId& sender, double now_s);
  void end() { open_ = false; }
  Verdict take(const msg::Jog& sample, const JogWriter& from, std::uint64_t tick, double now_s);

  /// Deflection of the selected axes; 0 while the stick is released or silent.
  [[nodiscard]] std::array<double, 3> deflection(double now_s) const;
  /// True while the stick is engaged and has been deflected within kLongest_s, and for kFirst_s while no
  /// sample has arrived.
  [[nodiscard]] bool active(double now_s) const;
  [[nodiscard]] bool open() const { return open_; }

 private:
  using Deflection = std::array<double, 3>;

  [[nodiscard]] bool of_session(const msg::Jog& sample, const JogWriter& from) const;
  [[nodiscard]] bool late(const msg::Jog& sample, std::uint64_t tick) const;
  [[nodiscard]] bool silent(double now_s) const {
    return last_sample_s_ && now_s - *last_sample_s_ > kSilence_s;
  }
  [[nodiscard]] bool acts(double now_s) const { return engaged_ && !silent(now_s); }
  [[nodiscard]] Deflection selected_of(const msg::Jog& sample) const;
  void release(double now_s);

  double period_s_;
  bool open_ = false;
  msg::Request request_{};
  bus::ParticipantId sender_ = bus::kUnknownParticipant;
  std::optional<bus::WriterId> writer_;  ///< nothing: no sample has arrived
  double begun_s_ = 0;
  double deflected_s_ = 0;  ///< last time at which a deflection acted; before the first deflection: begun_s_
  double neutral_s_ = 0;    ///< last time at which the stick was released or not deflected
  std::optional<double> last_sample_s_;  ///< time of the last sample; nothing: no sample has arrived since
                                         ///< the stick was released
  bool engaged_ = false;
  bool faulty_ = false;  ///< true: the stick is faulty, until the operator releases it or returns it to zero
  Deflection deflection_{};
};

}  // namespace crane::supervisor
