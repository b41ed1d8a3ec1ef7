#pragma once
/// A recorded run: inputs and outputs of the stack in each tick, rig file and controller. `crane run` writes
/// the samples in the order of the ticks, a recorder in the order of arrival.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "replay/arrival_order.hpp"
#include "replay/recorded_tick.hpp"

namespace crane::replay {

/// The recording cannot be replayed. what() has one line for each reason.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RecordedRun {
 public:
  /// @throws recording::ReadError, Refusal
  explicit RecordedRun(const std::filesystem::path& file);

  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  [[nodiscard]] const control::Controller& controller() const { return *controller_; }
  [[nodiscard]] const recording::Metadata& origin() const { return origin_; }  ///< metadata record "crane"

  /// True: a recorder has written the recording. Samples may be missing, and the processes have random
  /// start-up numbers.
  [[nodiscard]] bool by_recorder() const { return arrivals_.has_value(); }
  /// Text of the rig file.
  [[nodiscard]] const std::string& rig_text() const { return rig_text_; }

  /// Calls `visit` for each tick with a sample of a loop topic, until `visit` returns false.
  /// @throws Refusal when a topic has two samples of one tick in a recording of `crane run`
  void for_each(const std::function<bool(const RecordedTick&)>& visit);
  /// As ArrivalOrder::assumed_ticks(). @pre for_each() has run
  [[nodiscard]] std::uint64_t assumed_ticks() const { return arrivals_ ? arrivals_->assumed_ticks() : 0; }
  /// Damage found so far (McapReader::problems()).
  [[nodiscard]] const std::vector<std::string>& problems() const { return reader_.problems(); }

 private:
  void for_each_in_order(const std::function<bool(const RecordedTick&)>& visit);

  std::string file_;
  recording::McapReader reader_;
  recording::Metadata origin_;
  std::optional<ArrivalOrder> arrivals_;
  std::string rig_text_;
  configuration::Rig rig_;
  const control::Controller* controller_ = nullptr;
};

}  // namespace crane::replay
