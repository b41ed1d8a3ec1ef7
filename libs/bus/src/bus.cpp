#include "crane/bus/bus.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "back_end.hpp"
#include "crane/bus/cdr.hpp"

namespace crane::bus {
namespace {

constexpr std::array<std::string_view, 3> kVendorNames{"cyclone", "fastdds", "memory"};
constexpr std::array<std::string_view, 7> kEventNames{
    "matched",           "unmatched",        "deadline_missed", "liveliness_lost",
    "liveliness_gained", "incompatible_qos", "sample_lost"};

void require_sealable(const topics::Description& topic) {
  if (CdrCodec::of(*topic.descriptor).is_sealable()) return;
  throw Error{"topic " + std::string{topic.name} + ": type " + topic.descriptor->m_typename +
              " must begin with crane::Header and end with a uint32 for the CRC"};
}

std::shared_ptr<BackEnd> make_back_end(const Options& options, std::shared_ptr<Doorbell> doorbell) {
  switch (options.vendor) {
    case Vendor::cyclone:
      return make_cyclone(options, std::move(doorbell));
    case Vendor::fastdds:
      return make_fastdds(options, std::move(doorbell));
    case Vendor::memory:
      break;
  }
  return make_memory(options, std::move(doorbell));
}

}  // namespace

std::string_view to_string(Vendor vendor) { return kVendorNames.at(static_cast<std::size_t>(vendor)); }

std::optional<Vendor> vendor_from_string(std::string_view name) {
  for (const Vendor vendor : {Vendor::cyclone, Vendor::fastdds, Vendor::memory})
    if (to_string(vendor) == name) return vendor;
  return std::nullopt;
}

std::string_view to_string(EventKind kind) { return kEventNames.at(static_cast<std::size_t>(kind)); }

struct Bus::State {
  Options options;
  std::shared_ptr<Doorbell> doorbell = std::make_shared<Doorbell>();
  std::shared_ptr<BackEnd> back_end;
};

Bus::Bus(Options options) : state_{std::make_unique<State>()} {
  for (const auto& topic : topics::kAll) require_sealable(topic);  // at the start, not at the first sample
  state_->options = checked(std::move(options));
  state_->back_end = make_back_end(state_->options, state_->doorbell);
}
Bus::~Bus() = default;
Bus::Bus(Bus&&) noexcept = default;
Bus& Bus::operator=(Bus&&) noexcept = default;

bool Bus::wait(std::chrono::nanoseconds timeout) { return state_->doorbell->wait(timeout); }
const Options& Bus::options() const { return state_->options; }

std::unique_ptr<detail::Writer> Bus::make_writer(const topics::Description& topic,
                                                 const EndpointOptions& endpoint) {
  require_sealable(topic);
  if (!state_->options.credentials) return state_->back_end->writer(topic, endpoint);
  try {
    return state_->back_end->writer(topic, endpoint);
  } catch (const Error& error) {
    throw Error{std::string{error.what()} + "; may the role of " +
                state_->options.credentials->identity_certificate +
                " write this topic? `crane keys show DIR` lists what each role may write"};
  }
}

std::unique_ptr<detail::Reader> Bus::make_reader(const topics::Description& topic,
                                                 const EndpointOptions& endpoint) {
  require_sealable(topic);
  return state_->back_end->reader(topic, endpoint);
}

CdrSubscriber Bus::cdr_subscriber(const topics::Description& topic, const EndpointOptions& endpoint) {
  return {topic, make_reader(topic, endpoint)};
}

CdrSubscriber::CdrSubscriber(const topics::Description& topic, std::unique_ptr<detail::Reader> reader)
    : topic_{&topic}, reader_{std::move(reader)}, sample_(CdrCodec::of(*topic.descriptor).sample_bytes()) {}

std::optional<msg::Header> CdrSubscriber::take(std::vector<std::uint8_t>& cdr, SampleInfo* info) {
  constexpr std::array<std::uint8_t, 4> kPlainLittleEndian{0, 1, 0, 0};
  const CdrCodec& codec = CdrCodec::of(*topic_->descriptor);
  SampleInfo local;
  while (reader_->take(sample_.data(), local)) {
    if (local.valid && !detail::intact(*topic_, sample_.data())) {
      ++counts_.rejected;
      continue;
    }
    if (!local.valid && info == nullptr) continue;
    if (info != nullptr) *info = local;
    cdr.clear();
    if (local.valid) {
      ++counts_.taken;
      cdr.resize(kPlainLittleEndian.size() + codec.max_encoded_bytes());
      std::memcpy(cdr.data(), kPlainLittleEndian.data(), kPlainLittleEndian.size());
      const auto body = std::span{cdr}.subspan(kPlainLittleEndian.size());
      cdr.resize(kPlainLittleEndian.size() + codec.encode(sample_.data(), body));
    }
    msg::Header header{};
    std::memcpy(&header, sample_.data(), sizeof header);
    return header;
  }
  return std::nullopt;
}

}  // namespace crane::bus
