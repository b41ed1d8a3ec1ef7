#pragma once
/// One data set, scored: a line of JSON in the file of results.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "deck.hpp"
#include "judgement.hpp"

namespace crane::diagnosis::score {

struct Record {
  std::string deck = "truth";
  std::size_t number = 0;
  std::uint64_t seed = 0;
  std::string kind, rig, hidden;       ///< hidden: "command_delay@trolley + payload_mass"
  std::vector<std::string> causes;     ///< names, as hidden
  double multiple = 0, amplitude = 0;  ///< of the first effect
  std::string judged;  ///< name_of(Judged); "no data": the crane leaves its range; "failed": no answer
  std::string verdict, found;
  double gain = 0, oracle_gain = 0;  ///< oracle: refit of the true structure alone
  bool oracle = false;               ///< there is one
  std::vector<Compared> estimates;   ///< of the causes that are there
  std::string experiment;            ///< proposed next one
  std::string resolved;              ///< judged again with that run; empty: not tried
  double data_s = 0, runtime_s = 0, peak_mb = 0;
  std::map<std::string, double> nuisance;  ///< what the deck drew for the set, by name; may be empty
};

/// Generates, diagnoses, opens the answer, judges; then the oracle and, for confounded sets, the next
/// experiment.
[[nodiscard]] Record scored(const Set& set);

[[nodiscard]] std::string line_of(const Record& record);
/// Lines that end the file in the middle of a record are left out.
[[nodiscard]] std::vector<Record> read_records(const std::filesystem::path& file);
/// One write at the end of the file, so that several processes may share it. @throws std::runtime_error
void append(const std::filesystem::path& file, const Record& record);

/// The targets' table of the records, as Markdown. @param quiet without what was hidden in which set
[[nodiscard]] std::string table_of(const std::vector<Record>& records, bool quiet = false);
/// The sets in quarters of each nuisance, and the worst quarter; empty without nuisance.
[[nodiscard]] std::string quarters_of(const std::vector<Record>& records);

/// "command_delay@trolley + payload_mass", and what is as good as that in a diagnosis.
[[nodiscard]] std::string labels_of(const std::vector<HiddenEffect>& effects);
[[nodiscard]] std::string found_in(const Diagnosis& found);
/// Of this process.
[[nodiscard]] double peak_mb();
/// "12 of 30, 40 % [25, 58]": Wilson's interval of 95 %.
[[nodiscard]] std::string share(std::size_t hits, std::size_t of);

}  // namespace crane::diagnosis::score
