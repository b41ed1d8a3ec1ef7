#pragma once
/// All processes of the loop must have the same rig file and the same controller, because limits,
/// calibration, zones and gains depend on each other. Each sample of the loop states the configuration of its
/// process. A process that reads another configuration, or 0, states 0: the supervisor detects a difference
/// anywhere in the loop. Only the writer of a loop topic can state the configuration of its process. Statuses
/// on crane/node have no effect, because every process except operator tools and monitors may write
/// this topic.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "crane/topics.hpp"

namespace crane::runtime {

/// Compares the configurations of the inputs of one process with its own. No I/O.
template <std::size_t kInputs>
class Agreement {
 public:
  /// @param own  configuration::digest() of this process
  explicit Agreement(std::uint32_t own) : own_{own} { newest_.fill({own, crane_SOURCE_NONE}); }

  /// Takes the newest sample of an input; null: the sample is missing, and the previous sample remains valid.
  /// A topic without a configuration has no effect.
  template <class T>
  void note(std::size_t input, const T* sample) {
    if constexpr (requires { sample->configuration; })
      if (sample != nullptr) newest_[input] = {sample->configuration, sample->header.source};
  }
  /// @return the configuration of this process and of all inputs; 0 when they differ
  [[nodiscard]] std::uint32_t configuration() const {
    return std::ranges::all_of(newest_, [this](const Stated& one) { return one.configuration == own_; })
               ? own_
               : 0;
  }
  /// @return the first writer that has another configuration than this process; nothing when there is none
  [[nodiscard]] std::optional<crane_Source> other() const {
    for (const auto& one : newest_)
      if (one.configuration != own_ && one.configuration != 0) return one.source;
    return std::nullopt;
  }

 private:
  struct Stated {
    std::uint32_t configuration;
    crane_Source source;
  };
  std::uint32_t own_;
  std::array<Stated, kInputs> newest_;
};

}  // namespace crane::runtime
