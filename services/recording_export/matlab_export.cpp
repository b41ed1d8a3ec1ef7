#include "recording_export/matlab_export.hpp"

#include <matio.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "crane/recording/columns.hpp"
#include "recording_export/export_facts.hpp"

namespace crane::recording_export {
namespace {

using recording::Column;
using recording::ColumnTable;
using recording::Kind;

/// Level 5 states the size of a variable in a signed 32-bit number of bytes. The reserve is for the names and
/// the heads of the members.
constexpr std::size_t kMostBytes = (std::size_t{1} << 31U) - (std::size_t{1} << 24U);

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable checked(matvar_t* variable) {
  if (variable == nullptr) throw std::runtime_error("cannot write: the matio library reports an error");
  return {variable, Mat_VarFree};
}

/// Valid MATLAB name (letters, digits, underscores): "axis.position" -> "axis_position".
std::string matlab_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name.insert(0, "x");
  return name;
}

/// Text as UTF-16, the characters of MATLAB. @param text  valid UTF-8
std::u16string utf16(std::string_view text) {
  std::u16string units;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    std::uint32_t character = lead < 0x80   ? lead
                              : lead < 0xE0 ? lead & 0x1FU
                              : lead < 0xF0 ? lead & 0x0FU
                                            : lead & 0x07U;
    while (lead >= 0x80 && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U)
      character = character << 6U | (static_cast<unsigned char>(text[i++]) & 0x3FU);
    if (character >= 0x10000) {
      units += static_cast<char16_t>(0xD800U + ((character - 0x10000) >> 10U));
      character = 0xDC00U + ((character - 0x10000) & 0x3FFU);
    }
    units += static_cast<char16_t>(character);
  }
  return units;
}

Variable text_variable(const std::string& name, std::string_view text) {
  auto units = utf16(text);
  std::array<std::size_t, 2> size{units.empty() ? 0U : 1U, units.size()};
  return checked(Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UINT16, 2, size.data(), units.data(), 0));
}

/// Column of texts.
Variable cell_variable(const std::string& name, const std::vector<std::string>& texts, std::size_t width) {
  std::array<std::size_t, 2> size{width == 0 ? 0 : texts.size() / width, width};
  auto cell = checked(Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, size.data(), nullptr, 0));
  for (std::size_t row = 0; row < size[0]; ++row)
    for (std::size_t i = 0; i < width; ++i)
      Mat_VarSetCell(cell.get(), static_cast<int>(i * size[0] + row),
                     text_variable("", texts[row * width + i]).release());
  return cell;
}

struct MatType {
  matio_classes variable;
  matio_types data;
};
MatType mat_type(Kind kind) {
  switch (kind) {
    case Kind::int8:
      return {MAT_C_INT8, MAT_T_INT8};
    case Kind::boolean:
    case Kind::uint8:
      return {MAT_C_UINT8, MAT_T_UINT8};
    case Kind::int16:
      return {MAT_C_INT16, MAT_T_INT16};
    case Kind::uint16:
      return {MAT_C_UINT16, MAT_T_UINT16};
    case Kind::int32:
      return {MAT_C_INT32, MAT_T_INT32};
    case Kind::enumeration:
    case Kind::uint32:
      return {MAT_C_UINT32, MAT_T_UINT32};
    case Kind::int64:
      return {MAT_C_INT64, MAT_T_INT64};
    case Kind::uint64:
      return {MAT_C_UINT64, MAT_T_UINT64};
    case Kind::float32:
      return {MAT_C_SINGLE, MAT_T_SINGLE};
    case Kind::float64:
    case Kind::string:
    case Kind::structure:
      break;
  }
  return {MAT_C_DOUBLE, MAT_T_DOUBLE};
}

/// The values in column-major order, as MATLAB stores a matrix.
std::vector<std::uint8_t> by_element(const Column& column, std::size_t rows) {
  const auto size = recording::size_of(column.kind);
  std::vector<std::uint8_t> values(column.bytes.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < column.width; ++i)
      std::memcpy(&values[(i * rows + row) * size], &column.bytes[(row * column.width + i) * size], size);
  return values;
}

Variable values_variable(const Column& column, std::size_t rows) {
  if (column.kind == Kind::string) return cell_variable("", column.texts, column.width);
  auto values = by_element(column, rows);
  const auto type = mat_type(column.kind);
  std::array<std::size_t, 2> size{rows, column.width};
  return checked(Mat_VarCreate("", type.variable, type.data, 2, size.data(), values.data(),
                               column.kind == Kind::boolean ? MAT_F_LOGICAL : 0));
}

Variable times_variable(std::vector<std::int64_t> times_ns) {
  std::array<std::size_t, 2> size{times_ns.size(), 1};
  return checked(Mat_VarCreate("", MAT_C_INT64, MAT_T_INT64, 2, size.data(), times_ns.data(), 0));
}

/// A structure of one element, built member by member.
class Structure {
 public:
  explicit Structure(const std::string& name) {
    std::array<std::size_t, 2> size{1, 1};
    variable_ = checked(Mat_VarCreateStruct(name.c_str(), 2, size.data(), nullptr, 0));
  }
  void add(const std::string& member, Variable value) {
    const auto name = matlab_name(member);
    if (Mat_VarAddStructField(variable_.get(), name.c_str()) != 0)
      throw std::runtime_error("cannot write: member " + name);
    Mat_VarSetStructFieldByName(variable_.get(), name.c_str(), 0, value.release());
    ++members_;
  }
  [[nodiscard]] bool empty() const { return members_ == 0; }
  [[nodiscard]] Variable take() { return std::move(variable_); }
  [[nodiscard]] matvar_t* get() const { return variable_.get(); }

 private:
  Variable variable_{nullptr, Mat_VarFree};
  std::size_t members_ = 0;
};

Structure topic_structure(const std::string& topic, const std::string& type, const ColumnTable& table) {
  Structure structure{matlab_name(topic)};
  structure.add("log_time_ns", times_variable(table.log_times_ns()));
  structure.add("publish_time_ns", times_variable(table.publish_times_ns()));
  Structure units{""}, enumerators{""};
  units.add("log_time_ns", text_variable("", "ns"));
  units.add("publish_time_ns", text_variable("", "ns"));
  for (const auto& column : table.columns()) {
    structure.add(column.name, values_variable(column, table.rows()));
    if (const auto unit = common_unit(column); unit && !unit->empty())
      units.add(column.name, text_variable("", *unit));
    else if (!unit)
      units.add(column.name, cell_variable("", column.units, column.units.size()));
    if (!column.enumeration.empty()) enumerators.add(column.name, cell_variable("", column.enumerators, 1));
  }
  structure.add("units", units.take());
  if (!enumerators.empty()) structure.add("enumerators", enumerators.take());
  structure.add("type", text_variable("", type));
  return structure;
}

/// @param reason  used when errno is 0
[[noreturn]] void fail_to_write(const char* reason = "the matio library reports an error") {
  throw std::runtime_error(std::string{"cannot write: "} + (errno != 0 ? std::strerror(errno) : reason));
}

void write_variable(mat_t* file, const Structure& structure) {
  errno = 0;
  if (Mat_VarWrite(file, structure.get(), MAT_COMPRESSION_ZLIB) != 0) fail_to_write();
}

/// matio does not report every failed write. A complete file ends with its last variable.
void require_complete(const std::string& name, std::size_t variables) {
  constexpr std::streamoff kHead = 128, kTag = 8;
  std::ifstream file{name, std::ios::binary};
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(name));
  auto at = kHead;
  std::size_t found = 0;
  for (; at + kTag <= size; ++found) {
    std::array<std::uint32_t, 2> tag{};  // type and bytes of a variable
    if (!file.seekg(at).read(reinterpret_cast<char*>(tag.data()), kTag)) break;
    at += kTag + static_cast<std::streamoff>(tag[1]);
  }
  if (at != size || found != variables)
    fail_to_write("the file is incomplete, as on a full disk: check the free space");
}

/// @return number of variables
std::size_t write_contents(mat_t* file, recording::McapReader& recording, const std::string& topic) {
  Structure about{"recording"};
  for (const auto& [name, value] : export_facts(recording)) about.add(name, text_variable("", value));
  write_variable(file, about);
  auto tables = recording::column_tables(recording, topic);
  recording::Selection selection;
  for (const auto& channel : recording.channels())
    if (tables.contains(channel.id)) selection.topics.push_back(channel.topic);
  std::size_t variables = 1;
  if (selection.topics.empty()) return variables;
  recording.for_each(selection, [&](const recording::Message& message) {
    const auto found = tables.find(message.channel->id);
    if (found == tables.end()) return true;
    found->second.add(message);
    return true;
  });
  for (const auto& channel : recording.channels()) {
    const auto found = tables.find(channel.id);
    if (found == tables.end()) continue;
    const auto& table = found->second;
    if (table.bytes() > kMostBytes)
      throw std::runtime_error(
          channel.topic + " has " + std::to_string(table.bytes()) +
          " bytes, a MAT-file of level 5 holds 2 GiB per variable: export a part (crane log "
          "cut), or to hdf5");
    write_variable(file,
                   topic_structure(channel.topic, recording.find_schema(channel.schema_id)->name, table));
    tables.erase(found);
    ++variables;
  }
  return variables;
}

}  // namespace

void write_matlab(const std::filesystem::path& file, recording::McapReader& recording,
                  const std::string& topic) {
  write_completely(file, recording, [&](const std::string& partial) {
    errno = 0;
    std::unique_ptr<mat_t, decltype(&Mat_Close)> out{
        Mat_CreateVer(partial.c_str(), "MATLAB 5.0 MAT-file, exported by crane", MAT_FT_MAT5), Mat_Close};
    if (!out) throw std::runtime_error(std::string{"cannot create: "} + std::strerror(errno));
    const auto variables = write_contents(out.get(), recording, topic);
    errno = 0;
    if (Mat_Close(out.release()) != 0) fail_to_write();
    require_complete(partial, variables);
  });
}

}  // namespace crane::recording_export
