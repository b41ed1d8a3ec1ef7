#pragma once
/// Samples of one topic as columns with exact values: for export to formats that store arrays.
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crane/recording/kind.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/schema.hpp"

namespace crane::recording {

/// One field of a topic; all elements of an array, also of an array of structures, are one column.
struct Column {
  std::string name;  ///< "applied_v", "axis.position"
  Kind kind = Kind::float64;
  bool array = false;                    ///< true: the field is an array, possibly of one element
  std::size_t width = 0;                 ///< elements of one sample
  std::vector<std::string> units;        ///< by element; empty texts: none
  std::string enumeration;               ///< name of its type; empty: no enumeration
  std::vector<std::string> enumerators;  ///< by number
  std::vector<std::uint8_t> bytes;       ///< values in the byte order of the processor, sample by sample
  std::vector<std::string> texts;        ///< of Kind::string, instead of `bytes`
};

class ColumnTable {
 public:
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::int64_t>& log_times_ns() const { return log_times_ns_; }
  [[nodiscard]] const std::vector<std::int64_t>& publish_times_ns() const { return publish_times_ns_; }
  [[nodiscard]] std::size_t bytes() const;  ///< of all values

  /// Appends a row. @throws DecodeError
  void add(const Message& message);
  void clear_rows();

 private:
  friend class Schema;
  /// Place of an elementary value, in the order of the encoding.
  struct Element {
    std::size_t column = 0, index = 0;
  };
  std::string type_;
  std::vector<Column> columns_;
  std::vector<Element> elements_;
  std::vector<std::int64_t> log_times_ns_, publish_times_ns_;
  std::size_t rows_ = 0;
};

/// Empty tables of all topics that can be decoded, by channel id. @param topic  only this one; empty: all
[[nodiscard]] std::map<std::uint16_t, ColumnTable> column_tables(const McapReader& recording,
                                                                 const std::string& topic);

}  // namespace crane::recording
