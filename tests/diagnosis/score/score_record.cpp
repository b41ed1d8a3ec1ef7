#include "score/score_record.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace crane::diagnosis::score {
namespace {

using Json = nlohmann::ordered_json;

std::string label(const std::string& name, const std::string& axis) {
  return axis.empty() ? name : name + "@" + axis;
}

template <class Named>
std::string labels(const std::vector<Named>& all) {
  std::string text;
  for (const Named& one : all) text += (text.empty() ? "" : " + ") + label(one.name, one.axis);
  return text;
}

/// Oracle: the library contains only the hidden causes.
Diagnosis oracle(const SealedCase& sealed, const std::vector<HiddenEffect>& answer) {
  std::set<std::string> names;
  for (const plant::TermKind& kind : plant::term_kinds()) names.emplace(kind.name);
  for (const HiddenEffect& effect : answer) names.erase(effect.name);
  Request request;
  request.excluded.assign(names.begin(), names.end());
  request.most_effects = answer.size();
  return sealed.diagnosed(request);
}

Json json_of(const std::vector<Compared>& estimates) {
  Json all = Json::array();
  for (const Compared& one : estimates)
    all.push_back({{"cause", one.cause},
                   {"parameter", one.parameter},
                   {"truth", one.truth},
                   {"estimate", one.estimate},
                   {"std", one.std_dev}});
  return all;
}

std::vector<Compared> estimates_in(const Json& all) {
  std::vector<Compared> estimates;
  for (const Json& one : all)
    estimates.push_back(
        {one.at("cause"), one.at("parameter"), one.at("truth"), one.at("estimate"), one.at("std")});
  return estimates;
}

/// Usual length of a motion of the menu.
constexpr double kProposedSeconds = 24;

/// True when the training data with the proposed run give a clear verdict.
void try_experiment(const Set& set, Record& record) {
  truth::Case more = set.request;
  const std::string run = run_like(record.experiment);
  if (run.empty()) return;
  const double runs = std::ceil(kProposedSeconds / more.seconds);
  more.training_runs.insert(more.training_runs.end(), static_cast<std::size_t>(runs), run);
  const SealedCase sealed(more);
  record.resolved = name_of(judge(sealed.diagnosed(), sealed.answer()));
}

}  // namespace

std::string labels_of(const std::vector<HiddenEffect>& effects) { return labels(effects); }

std::string found_in(const Diagnosis& found) {
  std::string text = labels(found.causes);
  for (const std::string& rival : found.ambiguous_with) text += " or " + rival;
  if (found.verdict == Verdict::unknown && !found.remainder.from.empty())
    text += (text.empty() ? "" : "; ") + found.remainder.from[0];
  return text;
}

double peak_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

Record scored(const Set& set) {
  Record record;
  record.number = set.number;
  record.seed = set.request.seed;
  record.kind = name_of(set.kind);
  record.rig = set.request.rig;
  record.multiple = set.multiple;
  record.hidden = labels(set.request.effects);
  if (!set.request.effects.empty()) record.amplitude = set.request.effects[0].amplitude;
  try {
    const SealedCase sealed(set.request);
    const Diagnosis found = sealed.diagnosed();
    const auto answer = sealed.answer();
    record.hidden = labels_of(answer);
    for (const HiddenEffect& effect : answer) record.causes.push_back(effect.name);
    record.judged = name_of(judge(found, answer));
    record.verdict = diagnosis::name_of(found.verdict);
    record.found = found_in(found);
    record.gain = found.held_out.gain;
    record.runtime_s = found.runtime_s;
    record.data_s = set.request.seconds * static_cast<double>(set.request.training_runs.size());
    record.estimates = compared(found, answer);
    if (found.next_experiment) record.experiment = found.next_experiment->name;
    record.oracle = set.kind == Kind::single || set.kind == Kind::pair;
    if (record.oracle) record.oracle_gain = oracle(sealed, answer).held_out.gain;
    if (found.verdict == Verdict::ambiguous) try_experiment(set, record);
  } catch (const std::runtime_error& error) {
    record.judged = "no data";
    record.found = error.what();
  }
  record.peak_mb = peak_mb();
  return record;
}

std::string line_of(const Record& r) {
  const Json json{{"deck", r.deck},
                  {"number", r.number},
                  {"seed", r.seed},
                  {"kind", r.kind},
                  {"rig", r.rig},
                  {"hidden", r.hidden},
                  {"causes", r.causes},
                  {"multiple", r.multiple},
                  {"amplitude", r.amplitude},
                  {"judged", r.judged},
                  {"verdict", r.verdict},
                  {"found", r.found},
                  {"gain", r.gain},
                  {"oracle", r.oracle},
                  {"oracle_gain", r.oracle_gain},
                  {"estimates", json_of(r.estimates)},
                  {"experiment", r.experiment},
                  {"resolved", r.resolved},
                  {"data_s", r.data_s},
                  {"runtime_s", r.runtime_s},
                  {"peak_mb", r.peak_mb},
                  {"nuisance", r.nuisance}};
  return json.dump() + "\n";
}

std::vector<Record> read_records(const std::filesystem::path& file) {
  std::vector<Record> records;
  std::ifstream in{file};
  for (std::string line; std::getline(in, line);) {
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_discarded()) continue;
    Record r;
    r.deck = json.value("deck", "truth");
    r.nuisance = json.value("nuisance", r.nuisance);
    json.at("number").get_to(r.number);
    json.at("seed").get_to(r.seed);
    json.at("kind").get_to(r.kind);
    json.at("rig").get_to(r.rig);
    json.at("hidden").get_to(r.hidden);
    json.at("causes").get_to(r.causes);
    json.at("multiple").get_to(r.multiple);
    json.at("amplitude").get_to(r.amplitude);
    json.at("judged").get_to(r.judged);
    json.at("verdict").get_to(r.verdict);
    json.at("found").get_to(r.found);
    json.at("gain").get_to(r.gain);
    json.at("oracle").get_to(r.oracle);
    json.at("oracle_gain").get_to(r.oracle_gain);
    r.estimates = estimates_in(json.at("estimates"));
    json.at("experiment").get_to(r.experiment);
    json.at("resolved").get_to(r.resolved);
    json.at("data_s").get_to(r.data_s);
    json.at("runtime_s").get_to(r.runtime_s);
    json.at("peak_mb").get_to(r.peak_mb);
    records.push_back(std::move(r));
  }
  std::sort(records.begin(), records.end(),
            [](const Record& a, const Record& b) { return a.number < b.number; });
  return records;
}

void append(const std::filesystem::path& file, const Record& record) {
  const std::string line = line_of(record);
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool written =
      descriptor >= 0 && ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  if (descriptor >= 0) ::close(descriptor);
  if (!written) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace crane::diagnosis::score
