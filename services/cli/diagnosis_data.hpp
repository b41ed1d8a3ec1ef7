#pragma once
/// Reads recordings and CSV files for the diagnosis.
#include <filesystem>
#include <string>
#include <vector>

#include "crane/diagnosis/data.hpp"
#include "crane/diagnosis/mapping.hpp"

namespace crane::cli {

struct DiagnosisData {
  std::vector<diagnosis::Run> train, test;
  std::vector<std::string> notes;
};

/// Rows in which the supervisor permits motion; all rows when the table has no supervisor_state.
[[nodiscard]] recording::Table under_control(recording::Table table);

/// Files that end in .mcap are recordings, all others CSV files. The mapping describes the columns of CSV
/// files; for recordings, only its time range applies.
/// @throws diagnosis::DataError with the problems of all files
[[nodiscard]] DiagnosisData read_diagnosis_data(const std::vector<std::string>& train,
                                                const std::vector<std::string>& test,
                                                const diagnosis::Mapping& mapping,
                                                const configuration::Rig& rig);

}  // namespace crane::cli
