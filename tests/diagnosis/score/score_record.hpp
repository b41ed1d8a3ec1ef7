#pragma once
/// One data set, scored: a line of JSON in the file of results.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "score/deck.hpp"
#include "score/judgement.hpp"

namespace crane::diagnosis::score {

struct Record {
  std::string deck = "truth";
  std::size_t number = 0;
  std::uint64_t seed = 0;
  std::string kind, rig, hidden;       ///< hidden: "command_delay@trolley + payload_mass"
  std::vector<std::string> causes;     ///< names, as hidden
  double multiple = 0, amplitude = 0;  ///< multiple and amplitude of the first effect
  std::string judged;  ///< name_of(Judged); "no data": the crane leaves its range; "failed": no answer
  std::string verdict, found;
  double gain = 0, oracle_gain = 0;  ///< oracle_gain: refit of the true causes only
  bool oracle = false;               ///< an oracle exists
  std::vector<Compared> estimates;   ///< estimates of the hidden causes
  std::string experiment;            ///< proposed
  std::string resolved;              ///< judgement with the additional run; empty: not tried
  double data_s = 0, runtime_s = 0, peak_mb = 0;
  std::map<std::string, double> nuisance;  ///< drawn by the deck, by name; may be empty
};

/// Generates, diagnoses, opens the answer, judges; then the oracle and, for confounded sets, the next
/// experiment.
[[nodiscard]] Record scored(const Set& set);

[[nodiscard]] std::string line_of(const Record& record);
/// An incomplete record at the end of the file is ignored.
[[nodiscard]] std::vector<Record> read_records(const std::filesystem::path& file);
/// Appends the record with one write, so that several processes may share the file. @throws
/// std::runtime_error
void append(const std::filesystem::path& file, const Record& record);

/// Table of targets, as Markdown. @param quiet without hidden effects by set
[[nodiscard]] std::string table_of(const std::vector<Record>& records, bool quiet = false);
/// Table by quarters of each nuisance, with the worst; empty without nuisance.
[[nodiscard]] std::string quarters_of(const std::vector<Record>& records);

/// "command_delay@trolley + payload_mass"; also of a diagnosis.
[[nodiscard]] std::string labels_of(const std::vector<HiddenEffect>& effects);
[[nodiscard]] std::string found_in(const Diagnosis& found);
/// Peak memory of this process.
[[nodiscard]] double peak_mb();
/// "12 of 30, 40 % [25, 58]": Wilson's interval of 95 %.
[[nodiscard]] std::string share(std::size_t hits, std::size_t of);

}  // namespace crane::diagnosis::score
