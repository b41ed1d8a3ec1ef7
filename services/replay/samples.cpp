#include "replay/samples.hpp"

namespace crane::replay {
Cdr encoded(const topics::Description& topic, const void* sample) {
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  Cdr cdr{0, 1, 0, 0};  // plain CDR, little endian
  cdr.resize(bus::kEncapsulation_bytes + codec.max_encoded_bytes());
  cdr.resize(bus::kEncapsulation_bytes +
             codec.encode(sample, std::span{cdr}.subspan(bus::kEncapsulation_bytes)));
  return cdr;
}

std::optional<msg::Header> header_of(std::span<const std::uint8_t> cdr) {
  // tick (8 bytes), sample time (8), source (4), epoch (4): CDR adds no padding
  static_assert(sizeof(msg::Header) == 24 && offsetof(msg::Header, epoch) == 20);
  msg::Header header{};
  if (cdr.size() < bus::kEncapsulation_bytes + sizeof header) return std::nullopt;
  std::memcpy(&header, cdr.data() + bus::kEncapsulation_bytes, sizeof header);
  return header;
}

Cdr with_epoch(const topics::Description& topic, const Cdr& cdr, std::uint32_t epoch) {
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  std::vector<std::uint8_t> sample(codec.sample_bytes());
  const auto header = header_of(cdr);
  if (!header || !codec.decode(std::span{cdr}.subspan(bus::kEncapsulation_bytes), false, sample.data()))
    return cdr;
  bus::seal(topic, sample.data(), header->source, epoch);
  return encoded(topic, sample.data());
}

}  // namespace crane::replay
