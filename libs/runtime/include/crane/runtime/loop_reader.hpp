#pragma once
/// A subscriber of a loop topic that returns the samples of one writer only.
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/runtime/writer_binding.hpp"

namespace crane::runtime {

/// Type-independent part of a LoopReader, for the checks of a process.
class LoopInput {
 public:
  explicit LoopInput(const topics::Description& topic) : binding_{topic} {}
  virtual ~LoopInput() = default;
  [[nodiscard]] const WriterBinding& binding() const { return binding_; }
  [[nodiscard]] virtual int matched() const = 0;
  [[nodiscard]] virtual std::string origin_of(const bus::WriterId& writer) const = 0;
  [[nodiscard]] virtual std::uint64_t rejected() const = 0;  ///< samples with a wrong CRC
  /// Detects a second writer that is matched and has sent no sample. Call once per tick.
  void watch(std::int64_t now_ns) { binding_.watch(now_ns, matched_writers()); }

 protected:
  virtual void list_writers(std::vector<bus::WriterId>& writers) const = 0;
  [[nodiscard]] std::span<const bus::WriterId> matched_writers() {
    list_writers(writers_);
    return writers_;
  }
  WriterBinding binding_;

 private:
  std::vector<bus::WriterId> writers_;  ///< reused, to avoid an allocation per tick
};

template <class T>
class LoopReader final : public LoopInput {
 public:
  /// Maximum number of samples per poll() of a component: twice the history of a writer (128). The limit
  /// bounds the time of a poll() when a sender floods the topic. The remaining samples wait for the next
  /// poll().
  static constexpr std::size_t kMostPerPoll = 256;

  LoopReader(const topics::Topic<T>& topic, bus::Subscriber<T> subscriber)
      : LoopInput{topic.description}, subscriber_{std::move(subscriber)} {}

  struct Taken {
    const T& sample;  ///< valid until the next take()
    bool taken_over;  ///< true: first sample of a new writer; samples of the old writer must be discarded
  };
  /// @param budget  number of samples that this poll() may still take; each taken sample decrements it
  /// @return the next sample of the bound writer; nothing when there is none or the budget is used up
  std::optional<Taken> take(std::int64_t now_ns, std::size_t& budget) {
    bus::SampleInfo info;
    while (budget > 0) {
      if (!subscriber_.take_into(sample_, &info)) return std::nullopt;
      --budget;
      if (!info.valid) continue;
      const Writer writer{info.writer, sample_.header.source, sample_.header.epoch};
      if (!info.entered) {
        binding_.refuse_forged(writer, now_ns);
        continue;
      }
      if (binding_.is_own(writer, now_ns)) return Taken{sample_, false};
      const auto verdict = binding_.judge(writer, now_ns, matched_writers());
      if (verdict == WriterBinding::Verdict::foreign) continue;
      return Taken{sample_, verdict == WriterBinding::Verdict::taken_over};
    }
    return std::nullopt;
  }
  [[nodiscard]] int matched() const override { return subscriber_.matched(); }
  [[nodiscard]] std::string origin_of(const bus::WriterId& writer) const override {
    return subscriber_.origin_of(writer);
  }
  [[nodiscard]] std::uint64_t rejected() const override { return subscriber_.counts().rejected; }

 private:
  void list_writers(std::vector<bus::WriterId>& writers) const override {
    subscriber_.matched_writers(writers);
  }

  bus::Subscriber<T> subscriber_;
  T sample_{};  ///< newest sample that was taken
};

/// A reader for tools and tests, which have no ComponentSpec.
template <class T>
[[nodiscard]] std::shared_ptr<LoopReader<T>> loop_reader(bus::Bus& bus, const topics::Topic<T>& topic,
                                                         const bus::EndpointOptions& endpoint = {}) {
  return std::make_shared<LoopReader<T>>(topic, bus.subscriber(topic, endpoint));
}

}  // namespace crane::runtime
