#include <cstring>
#include <utility>

#include "memory/network.hpp"

namespace crane::bus {
namespace {

using memory::ReaderPort;
using memory::WriterPort;

class MemoryWriter final : public detail::Writer {
 public:
  MemoryWriter(std::shared_ptr<MemoryNetwork> network, WriterPort port)
      : network_{std::move(network)}, port_{std::move(port)} {
    for (const auto& field : CdrCodec::of(*port_.topic->descriptor).fields())
      if (field.kind == CdrCodec::Field::Kind::string) strings_.push_back(field);
    network_->add(port_);
  }
  MemoryWriter(const MemoryWriter&) = delete;
  MemoryWriter& operator=(const MemoryWriter&) = delete;
  ~MemoryWriter() override { network_->remove(port_); }

  bool write(const void* sample) override {
    const auto* bytes = static_cast<const char*>(sample);
    for (const auto& string : strings_)  // as in the DDS back ends, which also refuse an unterminated string
      if (strnlen(bytes + string.offset, string.count) == string.count) return false;
    network_->publish(port_, sample, false);
    return true;
  }
  bool dispose(const void* sample) override {
    network_->publish(port_, sample, true);
    return true;
  }
  bool assert_liveliness() override { return true; }
  bool wait_until_acknowledged(std::chrono::nanoseconds) override { return true; }  // write() delivers
  [[nodiscard]] int matched() const override { return static_cast<int>(port_.matched); }

 private:
  std::shared_ptr<MemoryNetwork> network_;
  std::vector<CdrCodec::Field> strings_;
  WriterPort port_;
};

class MemoryReader final : public detail::Reader {
 public:
  MemoryReader(std::shared_ptr<MemoryNetwork> network, ReaderPort port)
      : network_{std::move(network)}, port_{std::move(port)} {
    network_->add(port_);
  }
  MemoryReader(const MemoryReader&) = delete;
  MemoryReader& operator=(const MemoryReader&) = delete;
  ~MemoryReader() override { network_->remove(port_); }

  bool take(void* sample, SampleInfo& info) override {
    const auto stamp = network_->take(port_, sample);
    if (!stamp) return false;
    info = stamp->info;
    sealed_for_ = stamp->sealed_for;
    return true;
  }
  [[nodiscard]] bool delivered_as_sealed(std::uint32_t messages_version) const override {
    return sealed_for_ == messages_version;
  }
  [[nodiscard]] int matched() const override { return static_cast<int>(port_.matched); }
  void matched_writers(std::vector<WriterId>& writers) const override {
    network_->writers_of(port_, writers);
  }

 private:
  std::shared_ptr<MemoryNetwork> network_;
  ReaderPort port_;
  std::optional<std::uint32_t> sealed_for_;  ///< Stamp of the last taken sample
};

class MemoryBackEnd final : public BackEnd {
 public:
  explicit MemoryBackEnd(const Options& options)
      : network_{options.network},
        number_{network_->next_participant()},
        partition_{options.crane},
        messages_version_{options.messages_version} {}

  std::unique_ptr<detail::Writer> writer(const topics::Description& topic,
                                         const EndpointOptions& options) override {
    const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
    const auto depth = static_cast<std::size_t>(quality(topic, options).depth);
    return std::make_unique<MemoryWriter>(
        network_, WriterPort{port(topic, options), memory::History{codec, depth}, messages_version_});
  }
  std::unique_ptr<detail::Reader> reader(const topics::Description& topic, const EndpointOptions& options,
                                         std::shared_ptr<Doorbell> doorbell) override {
    return std::make_unique<MemoryReader>(network_, ReaderPort{port(topic, options), std::move(doorbell),
                                                               memory::SampleQueue{topic.descriptor->m_size},
                                                               quality(topic, options).reader_history});
  }

 private:
  [[nodiscard]] memory::Port port(const topics::Description& topic, const EndpointOptions& options) const {
    return {&topic, partition_, {options.on_event, topic.name}, number_};
  }

  std::shared_ptr<MemoryNetwork> network_;
  std::uint64_t number_;
  std::string partition_;
  std::uint32_t messages_version_;
};

}  // namespace

std::shared_ptr<BackEnd> make_memory(const Options& options) {
  return std::make_shared<MemoryBackEnd>(options);
}

}  // namespace crane::bus
