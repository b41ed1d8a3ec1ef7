#include "sweep/results.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>

#include "crane/fields/printable.hpp"

namespace crane::sweep {
namespace {

/// FNV-1a hash in hexadecimal digits.
std::string digest_of(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  std::ostringstream hex;
  hex << std::hex << hash;
  return hex.str();
}

Result header_of(const Sweep& sweep) {
  return {{"sweep", sweep.name}, {"runs", sweep.size()}, {"identity", digest_of(identity_of(sweep))}};
}

/// @return nothing when the line is no result
std::optional<std::size_t> run_number_of(const Result& result) {
  if (!result.is_object()) return std::nullopt;
  const auto run = result.find("run"), why = result.find("stopped_because");
  if (run == result.end() || !run->is_number_unsigned() || why == result.end() || !why->is_string())
    return std::nullopt;
  return run->get<std::size_t>();
}

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  const auto figures = experiment::to_json(experiment::Metrics{});
  for (const auto& [name, value] : figures.items()) names.push_back(name);
  return names;
}

}  // namespace

Result result_of(const Run& run, const experiment::ComparedRun& outcome) {
  Result result{{"run", run.number}, {"stopped_because", outcome.stopped_because}};
  if (outcome.metrics) result.update(experiment::to_json(*outcome.metrics));
  return result;
}

Result failed(const Run& run, const std::string& failure) {
  return {{"run", run.number}, {"stopped_because", "the process of the run ended with " + failure}};
}

Log::Log(std::filesystem::path file, const Sweep& sweep) : file_{std::move(file)}, runs_{sweep.size()} {
  const std::string header = header_of(sweep).dump();
  if (std::filesystem::exists(file_)) read(header);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw LogError(file_.string() + ": cannot be opened for writing");
  if (std::filesystem::file_size(file_) == 0) append(header);
}

Log::~Log() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Log::read(const std::string& header) {
  std::ifstream in{file_, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  std::size_t begin = 0, line_number = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++line_number;
    const std::string line = text.substr(begin, end - begin);
    if (begin == 0) {
      if (line != header)
        throw LogError(file_.string() +
                       ": has results of another sweep or of other rig and scenario files; choose another "
                       "directory, or remove this file");
      continue;
    }
    Result result = Result::parse(line, nullptr, false);
    const auto number = run_number_of(result);
    if (!number || *number >= runs_)
      throw LogError(file_.string() + ":" + std::to_string(line_number) + ": damaged: \"" +
                     fields::printable(line.substr(0, 40)) + "\"; remove this line, or the file");
    results_[*number] = std::move(result);
  }
  if (begin < text.size()) std::filesystem::resize_file(file_, begin);
}

void Log::append(const std::string& line) {
  const std::string whole = line + '\n';
  if (::write(descriptor_, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size()))
    throw LogError(file_.string() + ": cannot be written");
}

void Log::add(const Result& result) {
  append(result.dump());
  results_[result.at("run").get<std::size_t>()] = result;
}

std::string csv_of(const Sweep& sweep, const std::map<std::size_t, Result>& results) {
  const auto figures = figure_names();
  std::string text = "run,scenario,rig,variant,controller,seed,";
  for (const Draw& draw : sweep.draws) text += draw.key + ',';
  text += "stopped_because";
  for (const auto& name : figures) text += ',' + name;
  text += '\n';
  for (const auto& [number, result] : results) {
    const Run run = run_of(sweep, number);
    text += std::to_string(number);
    for (const std::string& name :
         {run.on->scenario.name, run.on->rig.name, run.variant, run.controller, std::to_string(run.seed)})
      text += ',' + experiment::csv_cell(name);
    for (const double value : run.drawn) text += ',' + recording::shortest(value);
    text += ',' + experiment::csv_cell(result.at("stopped_because"));
    for (const auto& name : figures)
      text += ',' + (result.contains(name) ? experiment::csv_cell(result.at(name)) : std::string{});
    text += '\n';
  }
  return text;
}

std::vector<Group> groups_of(const Sweep& sweep, const std::map<std::size_t, Result>& results) {
  std::vector<Group> groups;
  for (const auto& [number, result] : results) {
    const Run run = run_of(sweep, number);
    if (number % sweep.seeds == 0 || groups.empty())
      groups.push_back({.on = run.on, .variant = run.variant, .controller = run.controller});
    Group& group = groups.back();
    ++group.runs;
    const auto why = result.at("stopped_because").get<std::string>();
    if (!why.empty()) ++group.stopped, ++group.stops[why];
    const auto number_in = [&result](const char* name) {
      return result.contains(name) && result.at(name).is_number() ? result.at(name).get<double>()
                                                                  : std::numeric_limits<double>::quiet_NaN();
    };
    if (const double settled_s = number_in("settling_time_s"); !std::isnan(settled_s))
      group.settling_s.push_back(settled_s);
    const double swing_deg =
        std::max(number_in("largest_swing_radial_deg"), number_in("largest_swing_tangential_deg"));
    if (!std::isnan(swing_deg)) group.largest_swing_deg.push_back(swing_deg);
  }
  for (Group& group : groups) {
    std::sort(group.settling_s.begin(), group.settling_s.end());
    std::sort(group.largest_swing_deg.begin(), group.largest_swing_deg.end());
  }
  return groups;
}

double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace crane::sweep
