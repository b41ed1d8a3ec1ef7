#include "recording_export/hdf5_export.hpp"

#include <hdf5.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "crane/recording/columns.hpp"
#include "recording_export/export_facts.hpp"

namespace crane::recording_export {
namespace {

using recording::Column;
using recording::ColumnTable;
using recording::Kind;

/// Rows per write and per chunk of the file.
constexpr std::size_t kRows = 4096;
/// zlib: higher levels take longer and save little on noisy measurements.
constexpr unsigned kCompression = 1;

/// An identifier of the library, closed at the end of its scope.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closing) : id_{id}, close_{closing} {
    if (id < 0) fail();
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_{std::exchange(other.id_, -1)}, close_{other.close_} {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): an id for C functions

  static void check(herr_t result) {
    if (result < 0) fail();
  }
  /// Closes a file, whose last writes may fail.
  void close() { check(close_(std::exchange(id_, -1))); }

 private:
  [[noreturn]] static void fail() {
    throw std::runtime_error(std::string{"cannot write: "} +
                             (errno != 0 ? std::strerror(errno) : "the HDF5 library reports an error"));
  }
  hid_t id_;
  Close close_;
};

hid_t type_of(Kind kind) {
  switch (kind) {
    case Kind::int8:
      return H5T_NATIVE_INT8;
    case Kind::boolean:
    case Kind::uint8:
      return H5T_NATIVE_UINT8;
    case Kind::int16:
      return H5T_NATIVE_INT16;
    case Kind::uint16:
      return H5T_NATIVE_UINT16;
    case Kind::int32:
      return H5T_NATIVE_INT32;
    case Kind::enumeration:
    case Kind::uint32:
      return H5T_NATIVE_UINT32;
    case Kind::int64:
      return H5T_NATIVE_INT64;
    case Kind::uint64:
      return H5T_NATIVE_UINT64;
    case Kind::float32:
      return H5T_NATIVE_FLOAT;
    case Kind::float64:
    case Kind::string:
    case Kind::structure:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

Handle text_type() {
  Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
  Handle::check(H5Tset_size(type, H5T_VARIABLE));
  Handle::check(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

void write_attribute(hid_t object, const std::string& name, const Handle& type, const Handle& space,
                     const void* value) {
  const Handle attribute{H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
  Handle::check(H5Awrite(attribute, type, value));
}

void add_text(hid_t object, const std::string& name, const std::string& text) {
  const char* value = text.c_str();
  write_attribute(object, name, text_type(), Handle{H5Screate(H5S_SCALAR), H5Sclose}, &value);
}

void add_texts(hid_t object, const std::string& name, const std::vector<std::string>& texts) {
  std::vector<const char*> values;
  for (const auto& text : texts) values.push_back(text.c_str());
  const hsize_t count = values.size();
  write_attribute(object, name, text_type(), Handle{H5Screate_simple(1, &count, nullptr), H5Sclose},
                  values.data());
}

void add_number(hid_t object, const std::string& name, std::uint64_t number) {
  write_attribute(object, name, Handle{H5Tcopy(H5T_NATIVE_UINT64), H5Tclose},
                  Handle{H5Screate(H5S_SCALAR), H5Sclose}, &number);
}

/// A dataset that grows by rows.
class Dataset {
 public:
  /// @param width  elements of a row; 0: the dataset has one dimension
  Dataset(hid_t group, const std::string& name, Handle type, std::size_t width)
      : type_{std::move(type)}, width_{width}, set_{create(group, name, type_, width)} {}

  void append(const void* values, std::size_t rows) {
    if (rows == 0) return;
    const std::array<hsize_t, 2> start{rows_, 0}, count{rows, width_}, size{rows_ + rows, width_};
    Handle::check(H5Dset_extent(set_, size.data()));
    const Handle file_space{H5Dget_space(set_), H5Sclose};
    Handle::check(
        H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
    const Handle memory{H5Screate_simple(width_ == 0 ? 1 : 2, count.data(), nullptr), H5Sclose};
    Handle::check(H5Dwrite(set_, type_, memory, file_space, H5P_DEFAULT, values));
    rows_ += rows;
  }
  [[nodiscard]] hid_t id() const { return set_; }

 private:
  static Handle create(hid_t group, const std::string& name, const Handle& type, std::size_t width) {
    const int dimensions = width == 0 ? 1 : 2;
    const std::array<hsize_t, 2> size{0, width}, most{H5S_UNLIMITED, width}, chunk{kRows, width};
    const Handle space{H5Screate_simple(dimensions, size.data(), most.data()), H5Sclose};
    const Handle properties{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    Handle::check(H5Pset_chunk(properties, dimensions, chunk.data()));
    Handle::check(H5Pset_shuffle(properties));
    Handle::check(H5Pset_deflate(properties, kCompression));
    return {H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose};
  }

  Handle type_;
  std::size_t width_;
  Handle set_;
  hsize_t rows_ = 0;
};

/// The group of a topic.
class Group {
 public:
  Group(hid_t file, const std::string& topic, const std::string& type, const ColumnTable& table)
      : group_{create(file, topic)} {
    add_text(group_, "type", type);
    for (const char* name : {"log_time_ns", "publish_time_ns"}) {
      sets_.emplace_back(group_, name, Handle{H5Tcopy(H5T_NATIVE_INT64), H5Tclose}, 0);
      add_text(sets_.back().id(), "unit", "ns");
    }
    for (const auto& column : table.columns()) {
      auto value =
          column.kind == Kind::string ? text_type() : Handle{H5Tcopy(type_of(column.kind)), H5Tclose};
      sets_.emplace_back(group_, column.name, std::move(value), column.array ? column.width : 0);
      describe(sets_.back().id(), column);
    }
  }

  void append(const ColumnTable& table) {
    sets_[0].append(table.log_times_ns().data(), table.rows());
    sets_[1].append(table.publish_times_ns().data(), table.rows());
    for (std::size_t i = 0; i < table.columns().size(); ++i) {
      const auto& column = table.columns()[i];
      if (column.kind != Kind::string) {
        sets_[i + 2].append(column.bytes.data(), table.rows());
        continue;
      }
      std::vector<const char*> texts;
      for (const auto& text : column.texts) texts.push_back(text.c_str());
      sets_[i + 2].append(texts.data(), table.rows());
    }
  }

  void count(std::uint64_t samples) { add_number(group_, "samples", samples); }

 private:
  static Handle create(hid_t file, const std::string& topic) {
    const Handle properties{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
    Handle::check(H5Pset_create_intermediate_group(properties, 1));
    return {H5Gcreate2(file, ("/" + topic).c_str(), properties, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
  }
  static void describe(hid_t set, const Column& column) {
    if (const auto unit = common_unit(column); unit && !unit->empty())
      add_text(set, "unit", *unit);
    else if (!unit)
      add_texts(set, "unit", column.units);
    if (column.kind == Kind::boolean) add_texts(set, "enumerators", {"false", "true"});
    if (column.enumeration.empty()) return;
    add_text(set, "enumeration", column.enumeration);
    add_texts(set, "enumerators", column.enumerators);
  }

  Handle group_;
  std::vector<Dataset> sets_;  // the two times, then the columns
};

void write_contents(hid_t file, recording::McapReader& recording, const std::string& topic) {
  for (const auto& [name, value] : export_facts(recording)) add_text(file, name, value);
  auto tables = recording::column_tables(recording, topic);
  std::map<std::uint16_t, Group> groups;
  std::map<std::uint16_t, std::uint64_t> samples;
  recording::Selection selection;
  for (const auto& channel : recording.channels()) {
    const auto table = tables.find(channel.id);
    if (table == tables.end()) continue;
    selection.topics.push_back(channel.topic);
    groups.try_emplace(channel.id, file, channel.topic, recording.find_schema(channel.schema_id)->name,
                       table->second);
  }
  const auto write = [&](std::uint16_t id, ColumnTable& table) {
    groups.at(id).append(table);
    samples[id] += table.rows();
    table.clear_rows();
  };
  if (!groups.empty())
    recording.for_each(selection, [&](const recording::Message& message) {
      const auto found = tables.find(message.channel->id);
      if (found == tables.end()) return true;
      found->second.add(message);
      if (found->second.rows() == kRows) write(found->first, found->second);
      return true;
    });
  for (auto& [id, table] : tables) {
    write(id, table);
    groups.at(id).count(samples[id]);
  }
}

}  // namespace

void write_hdf5(const std::filesystem::path& file, recording::McapReader& recording,
                const std::string& topic) {
  // Every handle is closed below. After a failed write, the clean-up of the library at the end of the program
  // would crash.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported by exceptions
  write_completely(file, recording, [&](const std::string& partial) {
    errno = 0;
    Handle out{H5Fcreate(partial.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    write_contents(out, recording, topic);
    Handle::check(H5Fflush(out, H5F_SCOPE_GLOBAL));
    out.close();
  });
}

}  // namespace crane::recording_export
