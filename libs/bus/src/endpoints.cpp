/// Publishers and subscribers: seal, send, receive, check.
#include <cstring>

#include "crane/bus/cdr.hpp"
#include "crane/bus/path_stamps.hpp"
#include "crane/bus/seal.hpp"
#include "crane/protection.hpp"
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

/// Any program may write any text: replaces invisible characters for every reader (terminal, page, recording,
/// log), and updates the CRC.
void make_printable(const topics::Description& topic, std::uint32_t messages_version, void* sample) {
  if (!CdrCodec::of(*topic.descriptor).make_texts_printable(sample)) return;
  const auto header = *static_cast<const msg::Header*>(sample);
  seal(topic, sample, header.source, header.epoch, messages_version);
}

}  // namespace

UntypedPublisher::UntypedPublisher(std::unique_ptr<State> state) : state_{std::move(state)} {}
UntypedPublisher::~UntypedPublisher() = default;
UntypedPublisher::UntypedPublisher(UntypedPublisher&&) noexcept = default;
UntypedPublisher& UntypedPublisher::operator=(UntypedPublisher&&) noexcept = default;

bool UntypedPublisher::send(void* sample) {
  const topics::Description& topic = state_->topic;
  auto* const stamps = topic.every_tick ? path_stamps() : nullptr;
  const auto begin_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  seal(topic, sample, state_->source, state_->epoch, state_->messages_version);
  if (state_->ledger != nullptr) state_->ledger->enter(ledger_entry(topic, sample, state_->messages_version));
  const auto sealed_ns = stamps != nullptr ? PathStamps::now_ns() : 0;
  const bool sent = state_->writer->write(sample);
  if (stamps != nullptr)
    stamps->published(topic, *static_cast<const msg::Header*>(sample), begin_ns, sealed_ns);
  return sent;
}
bool UntypedPublisher::dispose_of(const void* sample) { return state_->writer->dispose(sample); }
bool UntypedPublisher::assert_liveliness() { return state_->writer->assert_liveliness(); }
bool UntypedPublisher::wait_until_acknowledged(std::chrono::nanoseconds timeout) {
  return state_->writer->wait_until_acknowledged(timeout);
}
int UntypedPublisher::matched() const { return state_->writer->matched(); }

CdrPublisher::CdrPublisher(const topics::Description& topic, UntypedPublisher&& untyped)
    : UntypedPublisher{std::move(untyped)},
      topic_{&topic},
      sample_(CdrCodec::of(*topic.descriptor).sample_bytes()) {}

bool CdrPublisher::publish(std::span<const std::uint8_t> cdr) {
  return cdr.size() >= kEncapsulation_bytes && cdr[1] == 1 &&
         CdrCodec::of(*topic_->descriptor).decode(cdr.subspan(kEncapsulation_bytes), false, sample_.data()) &&
         send(sample_.data());
}

UntypedSubscriber::UntypedSubscriber(std::unique_ptr<State> state) : state_{std::move(state)} {}
UntypedSubscriber::~UntypedSubscriber() = default;
UntypedSubscriber::UntypedSubscriber(UntypedSubscriber&&) noexcept = default;
UntypedSubscriber& UntypedSubscriber::operator=(UntypedSubscriber&&) noexcept = default;

int UntypedSubscriber::matched() const { return state_->reader->matched(); }
void UntypedSubscriber::matched_writers(std::vector<WriterId>& writers) const {
  state_->reader->matched_writers(writers);
}
std::string UntypedSubscriber::origin_of(const WriterId& writer) const {
  return state_->reader->origin_of(writer);
}
const ReaderCounts& UntypedSubscriber::counts() const { return state_->counts; }
const topics::Description& UntypedSubscriber::topic() const { return state_->topic; }

bool UntypedSubscriber::receive(void* sample, SampleInfo* info) {
  State& state = *state_;
  SampleInfo local;
  bool is_intact = true;
  while (take_next(*state.reader, state.topic, state.messages_version, sample, local, is_intact)) {
    if (!is_intact) {
      ++state.counts.rejected;
      continue;
    }
    if (!local.valid && info == nullptr) continue;
    if (local.valid && state.ledger != nullptr)
      local.entered = state.ledger->contains(ledger_entry(state.topic, sample, state.messages_version)) ||
                      !protection::enabled(protection::Protection::bus_ledger);
    if (info != nullptr) *info = local;
    if (local.valid) {
      ++state.counts.taken;
      if (state.has_texts) make_printable(state.topic, state.messages_version, sample);
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
