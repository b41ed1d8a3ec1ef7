#pragma once
/// Counts each missing sample of one topic once. DDS reports a loss before or after the gap in the ticks
/// becomes visible, also by more than a second: a report comes at once, the next sample only when receiving
/// goes on; or a heartbeat that reports the loss comes long after the next sample.
#include <array>
#include <cstdint>
#include <vector>

#include "crane/recording/loss.hpp"

namespace crane::recorder {

class MissingSamples {
 public:
  /// A gap and a report of the same samples wait this long for each other. Both then count; the later one of
  /// a pair that was farther apart does not count again.
  static constexpr std::int64_t kWait_ns = 1'000'000'000;

  struct Found {
    recording::LossCause cause;
    std::uint64_t samples;
    std::int64_t time_ns;  ///< log time of the newest gap or report
  };

  /// @param every_tick  the writer of the topic publishes every tick, so that gaps are visible
  explicit MissingSamples(bool every_tick) : every_tick_{every_tick} {}

  /// A sample has arrived after `ticks` ticks without a sample of the same writer; 0: no gap.
  void gap(std::uint64_t ticks, std::int64_t now_ns);
  /// DDS has lost samples (dds_lost), or the recorder has rejected samples (wrong_crc).
  void report(recording::LossCause cause, std::uint64_t samples, std::int64_t now_ns);
  /// Another writer has begun: the losses of the previous one have no gap any more.
  void begin_writer();
  /// @param all  also the gaps and reports that still wait for each other
  /// @return what must be noted now
  [[nodiscard]] std::vector<Found> take(std::int64_t now_ns, bool all);

 private:
  struct Waiting {
    std::uint64_t samples = 0;
    std::int64_t first_ns = 0, newest_ns = 0;
    void add(std::uint64_t more, std::int64_t now_ns);
    [[nodiscard]] bool due(std::int64_t now_ns, bool all) const;
  };
  struct Report {
    recording::LossCause cause;
    Waiting waiting{};
  };
  bool every_tick_;
  Waiting gap_;  ///< ticks without a sample and without a report
  std::array<Report, 2> reports_{
      {{.cause = recording::LossCause::wrong_crc}, {.cause = recording::LossCause::dds_lost}}};
  std::uint64_t awaited_ = 0;  ///< samples that were noted as reported; their gap is not visible yet
  std::uint64_t noted_ = 0;    ///< ticks that were noted as a gap; DDS has not reported them yet
};

}  // namespace crane::recorder
