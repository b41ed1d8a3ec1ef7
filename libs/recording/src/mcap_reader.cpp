#include "crane/recording/mcap_reader.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "crane/recording/parts.hpp"
#include "mcap_contents.hpp"
#include "mcap_format.hpp"

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

using mcap::Cursor;
using mcap::FormatError;
using mcap::Op;

Bytes as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool earlier(const Pending& a, const Pending& b) {
  return std::tie(a.message.log_time_ns, a.part, a.chunk_offset, a.position) <
         std::tie(b.message.log_time_ns, b.part, b.chunk_offset, b.position);
}

template <class Record>
std::vector<Record> values(const std::map<std::uint16_t, Record>& by_id) {
  std::vector<Record> list;
  list.reserve(by_id.size());
  for (const auto& [id, value] : by_id) list.push_back(value);
  return list;
}

}  // namespace

struct McapReader::State {
  explicit State(const std::filesystem::path& recording) : names{files_of(recording)} {
    if (names.size() > 1) find_gaps(parts_of(recording));
  }

  std::vector<std::filesystem::path> names;
  std::vector<std::unique_ptr<InputFile>> files;  // by part
  std::vector<Contents> opened;                   // moved to `contents`
  Contents contents;                              // of all parts
  std::vector<SchemaRecord> schemas;
  std::vector<ChannelRecord> channels;
  std::vector<std::string> problems;
  std::set<std::pair<std::size_t, std::uint64_t>> reported;  // places, to report each problem once
  bool indexed = true;

  void find_gaps(const std::vector<Part>& parts);
  void open();
  void open(const std::filesystem::path& name);
  void add(Contents part, std::size_t number);
  void require_one_recording();
  [[nodiscard]] MetadataRecord metadata_at(const Place& place) const;
  void report(const Place& place, const std::string& what);
  void load(const ChunkPlace& chunk, const Selection& selection, std::vector<Pending>& pending);
  [[nodiscard]] std::string content_of(const Place& place) const;
  [[nodiscard]] const ChannelRecord* channel(std::uint16_t id) const;
};

/// The quota of a recording deletes its first parts only.
void McapReader::State::find_gaps(const std::vector<Part>& parts) {
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].number != parts[i - 1].number + 1)
      problems.push_back(parts[i].file.string() + ": the part before it is missing");
}

void McapReader::State::open() {
  for (const auto& name : names) try {
      open(name);
    } catch (const ReadError& error) {
      if (names.size() == 1) throw;
      indexed = false;  // the other parts are readable
      problems.emplace_back(error.what());
    }
  if (files.empty()) throw ReadError(problems.front());
  for (std::size_t part = 0; part < files.size(); ++part) add(std::move(opened[part]), part);
  schemas = values(contents.schemas);
  channels = values(contents.channels);
  require_one_recording();
}

void McapReader::State::open(const std::filesystem::path& name) {
  auto file = std::make_unique<InputFile>(name);
  if (file->size() == 0) throw ReadError(file->name() + ": is empty");
  if (file->read(0, mcap::kMagic.size()) != mcap::kMagic)
    throw ReadError(file->name() + ": is not an MCAP recording");
  std::optional<Contents> found = read_index(*file);
  if (!found) {
    indexed = false;
    problems.push_back(file->name() + ": has no usable index: the file was truncated, damaged or not closed");
    found = walk(*file, problems);
  }
  opened.push_back(std::move(*found));
  files.push_back(std::move(file));
}

/// @throws ReadError when the part declares another type or topic with an id of an earlier part
void McapReader::State::add(Contents part, std::size_t number) {
  const auto take = [&](auto& all, auto& more) {
    for (auto& [id, record] : more)
      if (const auto [known, added] = all.try_emplace(id, record); !added && !(known->second == record))
        throw ReadError(files[number]->name() + ": has other types or topics than " + files.front()->name() +
                        ": it is no part of this recording");
  };
  take(contents.schemas, part.schemas);
  take(contents.channels, part.channels);
  const auto place = [&](auto& all, auto& more, auto& of) {
    for (auto& each : more) of(each).part = number;
    all.insert(all.end(), more.begin(), more.end());
  };
  auto itself = [](Place& each) -> Place& { return each; };
  auto chunk = [](ChunkPlace& each) -> Place& { return each.place; };
  place(contents.chunks, part.chunks, chunk);
  place(contents.metadata, part.metadata, itself);
  place(contents.attachments, part.attachments, itself);
}

/// Parts of one recording have equal metadata "crane".
void McapReader::State::require_one_recording() {
  if (files.size() < 2) return;
  std::map<std::size_t, Metadata> origins;
  for (const Place& place : contents.metadata) try {
      auto record = metadata_at(place);
      if (record.name == "crane") origins.try_emplace(place.part, std::move(record.entries));
    } catch (const FormatError&) {  // metadata() reports it
    }
  for (const auto& [part, origin] : origins)
    if (origin != origins.begin()->second)
      throw ReadError(files[part]->name() + ": belongs to another recording than " +
                      files[origins.begin()->first]->name() + ": their metadata \"crane\" differ");
}

void McapReader::State::report(const Place& place, const std::string& what) {
  if (reported.insert({place.part, place.offset}).second)
    problems.push_back(files[place.part]->name() + ": byte " + std::to_string(place.offset) + ": " + what);
}

const ChannelRecord* McapReader::State::channel(std::uint16_t id) const {
  const auto found =
      std::lower_bound(channels.begin(), channels.end(), id,
                       [](const ChannelRecord& c, std::uint16_t wanted) { return c.id < wanted; });
  return found != channels.end() && found->id == id ? &*found : nullptr;
}

/// Content of a record. @throws FormatError when the record is truncated
std::string McapReader::State::content_of(const Place& place) const {
  std::string bytes = files[place.part]->read(place.offset, place.length);
  if (bytes.size() != place.length || bytes.size() < mcap::kRecordHead)
    throw FormatError("record is truncated");
  return bytes.substr(mcap::kRecordHead);
}

MetadataRecord McapReader::State::metadata_at(const Place& place) const {
  const std::string content = content_of(place);
  Cursor cursor{content};
  auto name = fields::printable(cursor.text());
  return {std::move(name), cursor.map()};
}

void McapReader::State::load(const ChunkPlace& chunk, const Selection& selection,
                             std::vector<Pending>& pending) {
  const std::size_t before = pending.size();
  try {
    const auto records =
        std::make_shared<const std::string>(unpack_chunk(*files[chunk.place.part], chunk.place));
    Cursor cursor{*records};
    for (std::size_t position = 0; !cursor.empty(); ++position) {
      const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
      Cursor content{cursor.raw(cursor.number<std::uint64_t>())};
      if (op != Op::message) continue;
      const ChannelRecord* of = channel(content.number<std::uint16_t>());
      if (of == nullptr) throw FormatError("a message belongs to an unknown channel");
      Message message;
      message.channel = of;
      message.sequence = content.number<std::uint32_t>();
      message.log_time_ns = content.time();
      message.publish_time_ns = content.time();
      message.data = as_bytes(content.rest());
      const auto& topics = selection.topics;
      const bool wanted =
          topics.empty() || std::find(topics.begin(), topics.end(), of->topic) != topics.end();
      if (wanted && message.log_time_ns >= selection.from_ns && message.log_time_ns <= selection.until_ns)
        pending.push_back({message, chunk.place.part, chunk.place.offset, position, records});
    }
  } catch (const FormatError& error) {
    pending.resize(before);
    report(chunk.place, std::string{"chunk is damaged and skipped: "} + error.what());
  }
}

McapReader::McapReader(const std::filesystem::path& recording) : state_{std::make_unique<State>(recording)} {
  state_->open();
}
McapReader::~McapReader() = default;
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;

const std::vector<std::filesystem::path>& McapReader::files() const { return state_->names; }
const std::vector<SchemaRecord>& McapReader::schemas() const { return state_->schemas; }
const std::vector<ChannelRecord>& McapReader::channels() const { return state_->channels; }
bool McapReader::indexed() const { return state_->indexed; }
const std::vector<std::string>& McapReader::problems() const { return state_->problems; }

const SchemaRecord* McapReader::find_schema(std::uint16_t id) const {
  for (const SchemaRecord& schema : state_->schemas)
    if (schema.id == id) return &schema;
  return nullptr;
}

std::int64_t McapReader::first_time_ns() const {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const ChunkPlace& chunk : state_->contents.chunks)
    if (chunk.has_messages) first = std::min(first, chunk.first_ns);
  return first == std::numeric_limits<std::int64_t>::max() ? 0 : first;
}

std::int64_t McapReader::last_time_ns() const {
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  for (const ChunkPlace& chunk : state_->contents.chunks)
    if (chunk.has_messages) last = std::max(last, chunk.last_ns);
  return last == std::numeric_limits<std::int64_t>::min() ? 0 : last;
}

std::vector<MetadataRecord> McapReader::metadata() {
  std::vector<MetadataRecord> list;
  for (const Place& place : state_->contents.metadata) try {
      list.push_back(state_->metadata_at(place));
    } catch (const FormatError& error) {
      state_->report(place, std::string{"metadata are damaged and skipped: "} + error.what());
    }
  return list;
}

std::vector<AttachmentRecord> McapReader::attachments() {
  std::vector<AttachmentRecord> list;
  for (const Place& place : state_->contents.attachments) try {
      const std::string content = state_->content_of(place);
      Cursor cursor{content};
      AttachmentRecord attachment;
      attachment.time_ns = cursor.time();
      (void)cursor.time();
      attachment.name = fields::printable(cursor.text());
      attachment.media_type = cursor.text();
      const Bytes data = as_bytes(cursor.raw(cursor.number<std::uint64_t>()));
      attachment.data.assign(data.begin(), data.end());
      const std::size_t covered = content.size() - cursor.rest().size();
      const auto crc = cursor.number<std::uint32_t>();
      if (crc != 0 && crc != mcap::crc32(content.data(), covered)) throw FormatError("CRC is wrong");
      list.push_back(std::move(attachment));
    } catch (const FormatError& error) {
      state_->report(place, std::string{"attachment is damaged and skipped: "} + error.what());
    }
  return list;
}

struct MessageStream::State {
  McapReader::State* reader;
  Selection selection;
  std::vector<const ChunkPlace*> chunks;  ///< by their first log time
  std::size_t loaded = 0;                 ///< number of loaded chunks
  std::vector<Pending> pending;           ///< sorted
  std::size_t next = 0;                   ///< in `pending`

  /// A chunk that is not loaded yet may have earlier messages.
  [[nodiscard]] bool ready() const {
    return next < pending.size() &&
           (loaded == chunks.size() || pending[next].message.log_time_ns < chunks[loaded]->first_ns);
  }
  void load() {
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(next));
    next = 0;
    reader->load(*chunks[loaded++], selection, pending);
    std::sort(pending.begin(), pending.end(), earlier);
  }
};

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
