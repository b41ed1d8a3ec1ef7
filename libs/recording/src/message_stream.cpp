/// The messages of a recording in the order of log time: loads the chunks one by one and merges them.
#include <algorithm>
#include <tuple>
#include <utility>

#include "crane/recording/mcap_reader.hpp"
#include "mcap_format.hpp"
#include "mcap_reader_state.hpp"

namespace crane::recording {
/// A message and the chunk that contains its data.
struct Pending {
  Message message;
  std::size_t part = 0;
  std::uint64_t chunk_offset = 0;
  std::size_t position = 0;  // in the chunk
  std::shared_ptr<const std::string> chunk;
};

namespace {

bool earlier(const Pending& a, const Pending& b) {
  return std::tie(a.message.log_time_ns, a.part, a.chunk_offset, a.position) <
         std::tie(b.message.log_time_ns, b.part, b.chunk_offset, b.position);
}

bool selected(const Message& message, const Selection& by) {
  return (by.topics.empty() || std::ranges::find(by.topics, message.channel->topic) != by.topics.end()) &&
         message.log_time_ns >= by.from_ns && message.log_time_ns <= by.until_ns;
}

}  // namespace

struct MessageStream::State {
  McapReader::State* reader;
  Selection selection;
  std::vector<const ChunkPlace*> chunks;  ///< by their first log time
  std::size_t loaded = 0;                 ///< number of loaded chunks
  std::vector<Pending> pending;           ///< sorted
  std::size_t next = 0;                   ///< in `pending`

  /// True when no chunk that is not loaded yet can have an earlier message.
  [[nodiscard]] bool ready() const {
    return next < pending.size() &&
           (loaded == chunks.size() || pending[next].message.log_time_ns < chunks[loaded]->first_ns);
  }
  void load() {
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(next));
    next = 0;
    unpack(*chunks[loaded++]);
    std::sort(pending.begin(), pending.end(), earlier);
  }

 private:
  void unpack(const ChunkPlace& chunk);
};

/// Appends the selected messages of a chunk to `pending`. A damaged chunk is reported and skipped.
void MessageStream::State::unpack(const ChunkPlace& chunk) {
  const std::size_t before = pending.size();
  try {
    const auto records =
        std::make_shared<const std::string>(unpack_chunk(*reader->files[chunk.place.part], chunk.place));
    mcap::Cursor cursor{*records};
    for (std::size_t position = 0; !cursor.empty(); ++position) {
      const auto op = static_cast<mcap::Op>(cursor.number<std::uint8_t>());
      mcap::Cursor content{cursor.raw(cursor.number<std::uint64_t>())};
      if (op != mcap::Op::message) continue;
      const ChannelRecord* of = reader->channel(content.number<std::uint16_t>());
      if (of == nullptr) throw mcap::FormatError("a message belongs to an unknown channel");
      Message message;
      message.channel = of;
      message.sequence = content.number<std::uint32_t>();
      message.log_time_ns = content.time();
      message.publish_time_ns = content.time();
      message.data = as_bytes(content.rest());
      if (selected(message, selection))
        pending.push_back({message, chunk.place.part, chunk.place.offset, position, records});
    }
  } catch (const mcap::FormatError& error) {
    pending.resize(before);
    reader->report(chunk.place, std::string{"chunk is damaged and skipped: "} + error.what());
  }
}

MessageStream::MessageStream(std::unique_ptr<State> state) : state_{std::move(state)} {}
MessageStream::~MessageStream() = default;
MessageStream::MessageStream(MessageStream&&) noexcept = default;
MessageStream& MessageStream::operator=(MessageStream&&) noexcept = default;

const Message* MessageStream::next() {
  while (!state_->ready()) {
    if (state_->loaded == state_->chunks.size()) return nullptr;
    state_->load();
  }
  return &state_->pending[state_->next++].message;
}

MessageStream McapReader::messages(const Selection& selection) {
  auto stream = std::make_unique<MessageStream::State>(
      MessageStream::State{.reader = state_.get(), .selection = selection, .chunks = {}, .pending = {}});
  for (const ChunkPlace& chunk : state_->contents.chunks)
    if (chunk.has_messages && chunk.last_ns >= selection.from_ns && chunk.first_ns <= selection.until_ns)
      stream->chunks.push_back(&chunk);
  std::ranges::stable_sort(stream->chunks, {}, [](const ChunkPlace* chunk) { return chunk->first_ns; });
  return MessageStream{std::move(stream)};
}

void McapReader::for_each(const Selection& selection, const std::function<bool(const Message&)>& visit) {
  auto stream = messages(selection);
  while (const auto* message = stream.next())
    if (!visit(*message)) return;
}
}  // namespace crane::recording
