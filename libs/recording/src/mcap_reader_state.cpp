#include "mcap_reader_state.hpp"

#include <algorithm>

#include "mcap_format.hpp"

namespace crane::recording {
namespace {

template <class Record>
std::vector<Record> values(const std::map<std::uint16_t, Record>& by_id) {
  std::vector<Record> list;
  list.reserve(by_id.size());
  for (const auto& [id, value] : by_id) list.push_back(value);
  return list;
}

}  // namespace

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
    } catch (const mcap::FormatError&) {  // metadata() reports it
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
    throw mcap::FormatError("record is truncated");
  return bytes.substr(mcap::kRecordHead);
}

MetadataRecord McapReader::State::metadata_at(const Place& place) const {
  const std::string content = content_of(place);
  mcap::Cursor cursor{content};
  auto name = fields::printable(cursor.text());
  return {std::move(name), cursor.map()};
}

}  // namespace crane::recording
