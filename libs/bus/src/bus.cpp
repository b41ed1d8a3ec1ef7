#include "crane/bus/bus.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "back_end.hpp"
#include "crane/bus/bare.hpp"
#include "crane/bus/cdr.hpp"

namespace crane::bus {
namespace {

constexpr std::array<std::string_view, 3> kVendorNames{"cyclone", "fastdds", "memory"};
constexpr std::array<std::string_view, 7> kEventNames{
    "matched",           "unmatched",        "deadline_missed", "liveliness_lost",
    "liveliness_gained", "incompatible_qos", "sample_lost"};

/// The name of the crane is a DDS partition. A name with these characters matches several cranes, and a
/// request would move all of them. @throws Error
void require_one_crane(const Options& options) {
  if (options.crane.find_first_of("*?[]") != std::string::npos)
    throw Error{"crane = '" + options.crane +
                "': a program that writes needs the name of one crane, without * ? [ ]"};
}

void require_sealable(const topics::Description& topic) {
  if (CdrCodec::of(*topic.descriptor).is_sealable()) return;
  throw Error{"topic " + std::string{topic.name} + ": type " + topic.descriptor->m_typename +
              " must begin with crane::Header and end with a uint32 for the CRC"};
}

std::shared_ptr<BackEnd> make_back_end(const Options& options) {
  switch (options.vendor) {
    case Vendor::cyclone:
      return make_cyclone(options);
    case Vendor::fastdds:
      return make_fastdds(options);
    case Vendor::memory:
      break;
  }
  return make_memory(options);
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
  for (const auto& topic : topics::kAll)
    require_sealable(topic);  // reported at the start, not at the first sample
  state_->options = checked(std::move(options));
  state_->back_end = make_back_end(state_->options);
}
Bus::Bus(std::unique_ptr<State> state) : state_{std::move(state)} {}
Bus::~Bus() = default;
Bus::Bus(Bus&&) noexcept = default;
Bus& Bus::operator=(Bus&&) noexcept = default;

Bus Bus::share(crane_Source source, std::uint32_t epoch) const {
  auto state = std::make_unique<State>();
  state->options = state_->options;
  state->options.source = source;
  state->options.epoch = epoch;
  state->back_end = state_->back_end;
  return Bus{std::move(state)};
}

bool Bus::wait(std::chrono::nanoseconds timeout) { return state_->doorbell->wait(timeout); }
void Bus::call_on_arrival(ArrivalHandler on_arrival) {
  state_->doorbell->set_arrival_handler(std::move(on_arrival));
}
const Options& Bus::options() const { return state_->options; }

UntypedPublisher Bus::make_publisher(const topics::Description& topic, const EndpointOptions& endpoint) {
  require_sealable(topic);
  require_one_crane(state_->options);
  try {
    return UntypedPublisher{std::make_unique<UntypedPublisher::State>(
        UntypedPublisher::State{.topic = topic,
                                .writer = state_->back_end->writer(topic, endpoint),
                                .source = state_->options.source,
                                .epoch = state_->options.epoch,
                                .messages_version = state_->options.messages_version,
                                .ledger = topic.every_tick ? state_->options.ledger : nullptr})};
  } catch (const Error& error) {
    if (!state_->options.credentials) throw;
    throw Error{std::string{error.what()} + "; may the role of " +
                state_->options.credentials->identity_certificate +
                " write this topic? `crane keys show DIR` lists what each role may write"};
  }
}

UntypedSubscriber Bus::make_subscriber(const topics::Description& topic, const EndpointOptions& endpoint) {
  require_sealable(topic);
  return UntypedSubscriber{std::make_unique<UntypedSubscriber::State>(
      UntypedSubscriber::State{.topic = topic,
                               .has_texts = CdrCodec::of(*topic.descriptor).has_texts(),
                               .reader = state_->back_end->reader(topic, endpoint, state_->doorbell),
                               .messages_version = state_->options.messages_version,
                               .ledger = topic.every_tick ? state_->options.ledger : nullptr})};
}

CdrPublisher Bus::cdr_publisher(const topics::Description& topic, const EndpointOptions& endpoint) {
  return {topic, make_publisher(topic, endpoint)};
}

CdrSubscriber Bus::cdr_subscriber(const topics::Description& topic, const EndpointOptions& endpoint) {
  return CdrSubscriber{make_subscriber(topic, endpoint)};
}

struct BareLink::State {
  std::shared_ptr<Doorbell> doorbell = std::make_shared<Doorbell>();
  std::shared_ptr<BackEnd> back_end;
  std::unique_ptr<detail::Reader> reader;
  std::unique_ptr<detail::Writer> writer;
};

BareLink::BareLink(const Options& options, const topics::Description& reads,
                   const topics::Description& writes)
    : state_{std::make_unique<State>()} {
  state_->back_end = make_back_end(checked(options));
  state_->reader = state_->back_end->reader(reads, {}, state_->doorbell);
  state_->writer = state_->back_end->writer(writes, {});
}
BareLink::~BareLink() = default;

bool BareLink::write(const void* sample) { return state_->writer->write(sample); }
bool BareLink::take(void* sample) {
  SampleInfo info;
  return state_->reader->take(sample, info) && info.valid;
}
bool BareLink::wait(std::chrono::nanoseconds timeout) { return state_->doorbell->wait(timeout); }
bool BareLink::matched() const { return state_->reader->matched() > 0 && state_->writer->matched() > 0; }

std::vector<OtherVersion> Bus::other_versions() { return state_->back_end->other_versions(); }
std::vector<FoundEndpoint> Bus::found_endpoints() { return state_->back_end->found_endpoints(); }

}  // namespace crane::bus
