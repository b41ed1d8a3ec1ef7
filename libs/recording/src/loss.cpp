#include "crane/recording/loss.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "crane/recording/schema.hpp"
#include "mcap_format.hpp"

namespace crane::recording {
namespace {

constexpr std::string_view kType = "recorder::Loss";
constexpr std::string_view kIdl = R"(// Samples that are missing in this recording.
module recorder {
  enum Cause { QUEUE_FULL, DDS_LOST, WRONG_CRC, FILE_REMOVED, TICK_GAP };

  @final
  struct Loss {
    string<64> topic;
    Cause  cause;
    uint64 samples;
    int64  from_ns;   // log time of the first missing sample
    int64  until_ns;  // log time of the last missing sample
  };
};
)";

struct CauseName {
  std::string_view idl, text;
};
/// By LossCause.
constexpr std::array<CauseName, 5> kCauses{{{"QUEUE_FULL", "dropped: the disk was too slow"},
                                            {"DDS_LOST", "reported as lost by DDS"},
                                            {"WRONG_CRC", "rejected: wrong CRC"},
                                            {"FILE_REMOVED", "in a file that was deleted"},
                                            {"TICK_GAP", "not received: gap in the ticks"}}};

LossCause cause_named(const std::string& name) {
  const auto* const found = std::ranges::find(kCauses, name, &CauseName::idl);
  if (found == kCauses.end()) throw DecodeError("recorder::Loss.cause: " + name + " is not known");
  return static_cast<LossCause>(found - kCauses.begin());
}

/// Zeros up to the next multiple of `size`, counted from the end of the encapsulation header.
void align(mcap::Content& body, std::size_t size) {
  while (body.bytes().size() % size != 0) body.raw(std::string_view{"\0", 1});
}

}  // namespace

std::string_view to_string(LossCause cause) { return kCauses.at(static_cast<std::size_t>(cause)).text; }

std::uint16_t add_loss_channel(McapWriter& writer) {
  return writer.channel(writer.schema(kType, "omgidl", kIdl), kLossTopic, "cdr");
}

void write_loss(McapWriter& writer, std::uint16_t channel, const Loss& loss) {
  mcap::Content body;
  body.text(loss.topic + '\0');  // a CDR string contains its terminator
  align(body, sizeof(std::uint32_t));
  body.number(static_cast<std::uint32_t>(loss.cause));
  align(body, sizeof(std::uint64_t));
  body.number(loss.samples).time(loss.from_ns).time(loss.until_ns);
  std::vector<std::uint8_t> cdr{0, 1, 0, 0};  // plain CDR, little endian
  cdr.insert(cdr.end(), body.bytes().begin(), body.bytes().end());
  writer.message(channel, 0, loss.until_ns, loss.until_ns, cdr);
}

bool has_losses_channel(const McapReader& recording) {
  return std::ranges::any_of(recording.channels(),
                             [](const ChannelRecord& channel) { return channel.topic == kLossTopic; });
}

std::vector<Loss> losses_in(McapReader& recording) {
  const Schema schema{kIdl};
  std::vector<Loss> losses;
  if (!has_losses_channel(recording)) return losses;
  recording.for_each({.topics = {std::string{kLossTopic}}}, [&](const Message& message) {
    const auto sample = schema.decode(kType, message.data);
    losses.push_back({.topic = sample.at("topic"),
                      .cause = cause_named(sample.at("cause")),
                      .samples = sample.at("samples"),
                      .from_ns = sample.at("from_ns"),
                      .until_ns = sample.at("until_ns")});
    return true;
  });
  return losses;
}

}  // namespace crane::recording
