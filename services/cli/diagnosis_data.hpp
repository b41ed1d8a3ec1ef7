#pragma once
/// Recordings and CSV files as runs for the diagnosis.
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

/// Rows of a table in which the supervisor let the crane move; all of them where it does not say.
[[nodiscard]] recording::Table under_control(recording::Table table);

/// Files ending in .mcap are recordings, all others CSV; the mapping is for CSV; of a recording it selects
/// times.
/// @throws diagnosis::DataError with the problems of all files
[[nodiscard]] DiagnosisData read_diagnosis_data(const std::vector<std::string>& train,
                                                const std::vector<std::string>& test,
                                                const diagnosis::Mapping& mapping, const runtime::Rig& rig);

}  // namespace crane::cli
