#pragma once
/// A recording of a run in lockstep: what the stack received and published in each tick, and how the stack
/// was made.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/topics.hpp"

namespace crane::replay {

/// The recording cannot be replayed. what() has one line for each reason.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A sample as plain CDR with its encapsulation header.
using Cdr = std::vector<std::uint8_t>;

struct Received {
  const topics::Description* topic;
  Cdr cdr;
};

struct RecordedTick {
  std::uint64_t number = 0;
  std::vector<Received> inputs;             ///< of operators, before the state of this tick, in their order
  std::map<std::string_view, Cdr> samples;  ///< by name of the topic; loop topics only
  [[nodiscard]] const Cdr* find(const topics::Description& topic) const {
    const auto found = samples.find(topic.name);
    return found == samples.end() ? nullptr : &found->second;
  }
};

class RecordedRun {
 public:
  /// @throws recording::ReadError, Refusal
  explicit RecordedRun(const std::filesystem::path& file);

  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  [[nodiscard]] const control::Controller& controller() const { return *controller_; }
  [[nodiscard]] const recording::Metadata& origin() const { return origin_; }  ///< metadata record "crane"

  /// Calls `visit` for each tick with a sample of a loop topic, until `visit` returns false.
  /// @throws Refusal when a topic has two samples of one tick
  void for_each(const std::function<bool(const RecordedTick&)>& visit);
  /// Damage found so far (McapReader::problems()).
  [[nodiscard]] const std::vector<std::string>& problems() const { return reader_.problems(); }

 private:
  std::string file_;
  recording::McapReader reader_;
  recording::Metadata origin_;
  configuration::Rig rig_;
  const control::Controller* controller_ = nullptr;
};

}  // namespace crane::replay
