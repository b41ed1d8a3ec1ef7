#pragma once
/// Samples that a writer keeps for late-joining readers: the last `depth` samples of each instance.
#include <array>
#include <cstdint>
#include <vector>

#include "crane/bus/cdr.hpp"
#include "memory/sample_queue.hpp"

namespace crane::bus::memory {

class History {
 public:
  History(const CdrCodec& codec, std::size_t depth)
      : codec_{&codec}, keyed_{codec.has_key()}, depth_{depth} {}

  void keep(const void* sample, const Stamp& stamp) {
    SampleQueue& samples = instance(sample).samples;
    if (samples.size() == depth_) samples.pop();
    samples.push(sample, stamp);
  }
  /// Removes a disposed instance, so that readers that join later do not receive it.
  void forget(const void* sample) { instance(sample).samples.clear(); }

  template <class Visit>
  void each(const Visit& visit) const {
    for (const Instance& instance : instances_)
      for (std::size_t i = 0; i < instance.samples.size(); ++i)
        visit(instance.samples.sample(i), instance.samples.stamp(i));
  }

 private:
  using Key = std::array<std::uint8_t, 8>;
  struct Instance {
    Key key;
    SampleQueue samples;
  };

  Instance& instance(const void* sample) {
    if (!keyed_ && !instances_.empty()) return instances_.front();
    Key key{};
    (void)codec_->encode_key(sample, key);
    for (Instance& known : instances_)
      if (known.key == key) return known;
    return instances_.emplace_back(Instance{key, SampleQueue{codec_->sample_bytes()}});
  }

  const CdrCodec* codec_;
  bool keyed_;
  std::size_t depth_;
  std::vector<Instance> instances_;
};

}  // namespace crane::bus::memory
