#include "mcap_summary.hpp"

#include "mcap_format.hpp"

namespace crane::recording::mcap {

void Summary::keep(std::vector<std::string>& records, std::string record_bytes) {
  bytes_ += record_bytes.size();
  records.push_back(std::move(record_bytes));
}

std::uint64_t Summary::messages() const {
  std::uint64_t total = 0;
  for (const auto& [channel, count] : counts) total += count;
  return total;
}

std::string Summary::closing(std::uint64_t base) const {
  std::string out = record(Op::data_end, Content{}.number(std::uint32_t{0}).bytes());
  const std::size_t summary_at = out.size();
  std::string offsets;
  const auto group = [&](Op op, const std::vector<std::string>& records) {
    const std::size_t at = out.size();
    for (const std::string& each : records) out += each;
    if (out.size() == at) return;
    offsets += record(Op::summary_offset, Content{}
                                              .number(static_cast<std::uint8_t>(op))
                                              .number(base + at)
                                              .number(static_cast<std::uint64_t>(out.size() - at))
                                              .bytes());
  };
  Content per_channel;
  for (const auto& [channel, count] : counts) per_channel.number(channel).number(count);
  const auto size32 = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  group(Op::schema, schemas);
  group(Op::channel, channels);
  group(Op::statistics, {record(Op::statistics, Content{}
                                                    .number(messages())
                                                    .number(static_cast<std::uint16_t>(schemas.size()))
                                                    .number(size32(channels))
                                                    .number(size32(attachments))
                                                    .number(size32(metadata))
                                                    .number(size32(chunks))
                                                    .time(span.first)
                                                    .time(span.last)
                                                    .text(per_channel.bytes())
                                                    .bytes())});
  group(Op::chunk_index, chunks);
  group(Op::attachment_index, attachments);
  group(Op::metadata_index, metadata);
  const std::uint64_t offsets_at = base + out.size();
  out += offsets;
  const Content footer = Content{}.number(base + summary_at).number(offsets_at);
  // The CRC covers the summary and the footer up to the CRC field.
  Content head;
  head.number(static_cast<std::uint8_t>(Op::footer)).number(std::uint64_t{kFooterSize}).raw(footer.bytes());
  out += head.bytes();
  out += Content{}.number(crc32(out.data() + summary_at, out.size() - summary_at)).bytes();
  out += kMagic;
  return out;
}

}  // namespace crane::recording::mcap
