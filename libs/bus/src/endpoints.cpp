/// Publishers and subscribers: seal, send, receive, check.
#include <cstring>

#include "crane/bus/cdr.hpp"
#include "crane/bus/path_stamps.hpp"
#include "crane/bus/seal.hpp"
#include "endpoint.hpp"

namespace crane::bus {
namespace {

/// Takes the next sample and checks its CRC. @return false when there is none
bool take_next(detail::Reader& reader, const topics::Description& topic, std::uint32_t messages_version,
               void* sample, SampleInfo& info, bool& is_intact) {
  auto* const stamps = path_stamps();
  const auto begin_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  const bool taken = reader.take(sample, info);
  const auto taken_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  is_intact = !taken || !info.valid || reader.delivered_as_sealed(messages_version) ||
              intact(topic, sample, messages_version);
  if (stamps != nullptr) stamps->took(begin_ns, taken_ns, PathStamps::now_ns());
  return taken;
}

}  // namespace

UntypedPublisher::UntypedPublisher(const topics::Description& topic, std::unique_ptr<detail::Writer> writer,
                                   const Options& options)
    : topic_{&topic},
      writer_{std::move(writer)},
      source_{options.source},
      epoch_{options.epoch},
      messages_version_{options.messages_version} {}
UntypedPublisher::~UntypedPublisher() = default;
UntypedPublisher::UntypedPublisher(UntypedPublisher&&) noexcept = default;
UntypedPublisher& UntypedPublisher::operator=(UntypedPublisher&&) noexcept = default;

bool UntypedPublisher::send(void* sample) {
  auto* const stamps = topic_->every_tick ? path_stamps() : nullptr;
  const auto begin_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  seal(*topic_, sample, source_, epoch_, messages_version_);
  const auto sealed_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  const bool sent = writer_->write(sample);
  if (stamps != nullptr)
    stamps->published(*topic_, *static_cast<const msg::Header*>(sample), begin_ns, sealed_ns);
  return sent;
}
bool UntypedPublisher::dispose_of(const void* sample) { return writer_->dispose(sample); }
bool UntypedPublisher::assert_liveliness() { return writer_->assert_liveliness(); }
int UntypedPublisher::matched() const { return writer_->matched(); }

CdrPublisher::CdrPublisher(const topics::Description& topic, UntypedPublisher&& untyped)
    : UntypedPublisher{std::move(untyped)},
      topic_{&topic},
      sample_(CdrCodec::of(*topic.descriptor).sample_bytes()) {}

bool CdrPublisher::publish(std::span<const std::uint8_t> cdr) {
  return cdr.size() >= kEncapsulation_bytes && cdr[1] == 1 &&
         CdrCodec::of(*topic_->descriptor).decode(cdr.subspan(kEncapsulation_bytes), false, sample_.data()) &&
         send(sample_.data());
}

UntypedSubscriber::UntypedSubscriber(const topics::Description& topic, std::unique_ptr<detail::Reader> reader,
                                     const Options& options)
    : topic_{&topic},
      has_texts_{CdrCodec::of(*topic.descriptor).has_texts()},
      reader_{std::move(reader)},
      messages_version_{options.messages_version} {}
UntypedSubscriber::~UntypedSubscriber() = default;
UntypedSubscriber::UntypedSubscriber(UntypedSubscriber&&) noexcept = default;
UntypedSubscriber& UntypedSubscriber::operator=(UntypedSubscriber&&) noexcept = default;

int UntypedSubscriber::matched() const { return reader_->matched(); }

/// Any program may write any text. Every reader (terminal, page, recording, log) gets only visible text, and
/// the CRC of this text.
void UntypedSubscriber::make_printable(void* sample) const {
  if (!CdrCodec::of(*topic_->descriptor).make_texts_printable(sample)) return;
  const auto header = *static_cast<const msg::Header*>(sample);
  seal(*topic_, sample, header.source, header.epoch, messages_version_);
}

bool UntypedSubscriber::receive(void* sample, SampleInfo* info) {
  SampleInfo local;
  bool is_intact = true;
  while (take_next(*reader_, *topic_, messages_version_, sample, local, is_intact)) {
    if (!is_intact) {
      ++counts_.rejected;
      continue;
    }
    if (!local.valid && info == nullptr) continue;
    if (info != nullptr) *info = local;
    if (local.valid) {
      ++counts_.taken;
      if (has_texts_) make_printable(sample);
    }
    return true;
  }
  return false;
}

CdrSubscriber::CdrSubscriber(UntypedSubscriber&& untyped)
    : UntypedSubscriber{std::move(untyped)}, sample_(CdrCodec::of(*topic().descriptor).sample_bytes()) {}

std::optional<msg::Header> CdrSubscriber::take(std::vector<std::uint8_t>& cdr, SampleInfo* info) {
  constexpr std::array<std::uint8_t, 4> kPlainLittleEndian{0, 1, 0, 0};
  const CdrCodec& codec = CdrCodec::of(*topic().descriptor);
  SampleInfo local;
  do {
    if (!receive(sample_.data(), &local)) return std::nullopt;
  } while (!local.valid && info == nullptr);
  if (info != nullptr) *info = local;
  cdr.clear();
  if (local.valid) {
    cdr.resize(kPlainLittleEndian.size() + codec.max_encoded_bytes());
    std::memcpy(cdr.data(), kPlainLittleEndian.data(), kPlainLittleEndian.size());
    const auto body = std::span{cdr}.subspan(kPlainLittleEndian.size());
    cdr.resize(kPlainLittleEndian.size() + codec.encode(sample_.data(), body));
  }
  msg::Header header{};
  std::memcpy(&header, sample_.data(), sizeof header);
  return header;
}

}  // namespace crane::bus
