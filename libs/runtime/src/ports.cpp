#include "crane/runtime/ports.hpp"

#include "crane/bus/path_stamps.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace crane::runtime {
namespace {

/// Topics are inline variables, which may have several addresses. Their names are unique.
bool same_topic(const topics::Description& a, const topics::Description& b) { return a.name == b.name; }

std::logic_error wrong_wiring(const ComponentSpec& spec, const topics::Description& topic,
                              const std::string& what) {
  return std::logic_error{std::string{spec.name} + " " + what + " " + std::string{topic.name} +
                          ": correct `reads` and `writes` of its ComponentSpec"};
}

}  // namespace

void Ports::declared_read(const topics::Description& topic) {
  const bool declared = std::ranges::any_of(spec_.reads, [&](const Read& read) {
    return same_topic(*read.topic, topic) && is_needed(read, controller_);
  });
  if (!declared) throw wrong_wiring(spec_, topic, "does not declare that it reads");
  made_.push_back(&topic);
}

bool Ports::declared_write(const topics::Description& topic) {
  const auto write = std::ranges::find_if(spec_.writes, [&](const Write& declared) {
    return same_topic(*declared.topic, topic) && is_written(declared, design_);
  });
  if (write == spec_.writes.end()) throw wrong_wiring(spec_, topic, "does not declare that it writes");
  if (!topics::may_write(topic, spec_.source)) throw wrong_wiring(spec_, topic, "is no permitted writer of");
  made_.push_back(&topic);
  return write->needs_reader && topic.every_tick;
}

void Ports::require_complete() const {
  const auto made = [&](const topics::Description& topic) {
    return std::ranges::any_of(made_, [&](const auto* other) { return same_topic(*other, topic); });
  };
  for (const auto& read : spec_.reads)
    if (is_needed(read, controller_) && !made(*read.topic))
      throw wrong_wiring(spec_, *read.topic, "declares and does not read");
  for (const auto& write : spec_.writes)
    if (is_written(write, design_) && !made(*write.topic))
      throw wrong_wiring(spec_, *write.topic, "declares and does not write");
}

bool Ports::connected() const {
  return std::ranges::all_of(loop_inputs_, [](const auto& input) { return input->matched() > 0; }) &&
         std::ranges::all_of(readers_, [](const auto& readers) { return readers() > 0; });
}

void Ports::watch(std::int64_t now_ns) {
  if (auto* const stamps = bus::path_stamps()) stamps->joined();
  if (clock_ == Clock::lockstep) return;  // in virtual time, a writer cannot be silent
  for (const auto& input : loop_inputs_) input->watch(now_ns);
}

bool Ports::disputed(std::int64_t now_ns) const {
  return std::ranges::any_of(loop_inputs_,
                             [now_ns](const auto& input) { return input->binding().disputed(now_ns); });
}

std::string Ports::dispute(std::int64_t now_ns) const {
  std::string text;
  for (const auto& input : loop_inputs_) {
    const auto& binding = input->binding();
    if (!binding.disputed(now_ns)) continue;
    text += (text.empty() ? "" : "; ") + std::string{binding.topic().name} + ": " +
            binding.dispute([&](const bus::WriterId& writer) { return input->origin_of(writer); });
  }
  return text;
}

std::uint64_t Ports::foreign() const {
  return std::accumulate(
      loop_inputs_.begin(), loop_inputs_.end(), std::uint64_t{0},
      [](std::uint64_t sum, const auto& input) { return sum + input->binding().foreign(); });
}

std::uint64_t Ports::rejected() const {
  return std::accumulate(loop_inputs_.begin(), loop_inputs_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& input) { return sum + input->rejected(); });
}

}  // namespace crane::runtime
