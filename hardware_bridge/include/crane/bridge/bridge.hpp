#pragma once
/// The loop between board and bus, and the clock master of the stack. At tick k the bridge latches the
/// encoders, writes command k-1 and publishes state k. The loop is the same for every board.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/bridge/homing.hpp"
#include "crane/bridge/last_line.hpp"
#include "crane/bridge/measurement.hpp"
#include "crane/bridge/probation.hpp"
#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"
#include "crane/runtime/request_inbox.hpp"
#include "crane/runtime/tick_join.hpp"

namespace crane::bridge {

/// Topics of every component that runs a Bridge.
[[nodiscard]] std::vector<runtime::Read> bridge_reads();
[[nodiscard]] std::vector<runtime::Write> bridge_writes();

class Bridge : public runtime::Component {
 public:
  Bridge(const runtime::Context& context, std::unique_ptr<Board> board);
  /// Leaves the board at 0 V with brakes closed.
  ~Bridge() override;
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  [[nodiscard]] std::string_view name() const override { return node_.identity().name; }
  bool poll(std::int64_t now_ns) override;
  [[nodiscard]] std::int64_t wake_at_ns() const override;
  [[nodiscard]] bool paced() const override { return clock_ == runtime::Clock::realtime; }
  [[nodiscard]] std::string waiting_for() const override;

 private:
  [[nodiscard]] bool tick_is_due(std::int64_t now_ns);
  void take_commands(std::int64_t now_ns);
  void take_requests(std::int64_t now_ns);
  [[nodiscard]] Inputs latch(std::int64_t& now_ns);
  void tick(const Inputs& inputs, std::int64_t now_ns);
  void apply(Outputs outputs);
  [[nodiscard]] Latched latched_at(std::optional<std::uint64_t> previous, std::uint64_t next,
                                   std::int64_t sample_time_ns) const;
  void step_homing(const Observation& observation);
  void report_latch();
  void report_relay(const Inputs& inputs, std::int64_t now_ns);
  [[nodiscard]] Observation observation(const Inputs& inputs) const;
  [[nodiscard]] msg::State state(const Inputs& inputs, const control::Measurement& measured,
                                 std::int64_t sample_time_ns) const;

  runtime::Node& node_;
  runtime::Clock clock_;
  std::int64_t (*monotonic_ns_)();
  std::int64_t period_ns_;
  std::unique_ptr<Board> board_;
  MeasurementPipeline measurement_;
  LastLine last_line_;
  Homing homing_;
  Probation probation_;
  runtime::Ports& ports_;
  runtime::Output<msg::State> states_;
  std::shared_ptr<runtime::LoopReader<msg::Command>> commands_;
  runtime::RequestInbox requests_;
  runtime::RecentTicks ticks_;  ///< headers of the last published states
  runtime::JoinCounts counts_;
  std::optional<CommandView> command_;
  std::optional<std::uint64_t> tick_;  ///< last published tick
  std::uint64_t until_tick_ = 0;       ///< lockstep: last tick that is permitted
  std::int64_t start_ns_ = 0;          ///< real time: time of tick 0
  std::uint32_t overruns_ = 0;
  std::array<configuration::Drive, kDrives> drives_;
  std::array<double, kDrives> unit_per_count_{};  ///< m or rad per count, with the sign of the encoder
  std::array<double, kDrives> applied_v_{};       ///< output voltages of the converters, positive outward
  Reason reported_ = Reason::none;
  bool relay_closed_ = false;     ///< state of the relay at the last tick
  bool toggles_ = false;          ///< true: the watchdog output toggled at the last tick
  std::int64_t ticked_ns_ = 0;    ///< time of the last tick
  std::int64_t interval_ns_ = 0;  ///< time between the last two ticks
};

}  // namespace crane::bridge
