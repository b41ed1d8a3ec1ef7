#include <algorithm>
#include <set>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/rig_fields.hpp"
#include "crane/configuration/toml_reader.hpp"
#include "crane/experiment/variant.hpp"
#include "crane/runtime/process.hpp"
#include "crane/simulator/component.hpp"
#include "stack/data_files.hpp"
#include "sweep/draw.hpp"
#include "sweep/sweep.hpp"

namespace crane::sweep {
namespace {

using configuration::ConfigurationError;
using configuration::Range;
using configuration::Rig;
using configuration::TomlTable;
using Names = std::vector<std::string>;

constexpr int kMostSeeds = 1'000'000;
constexpr std::size_t kMostRuns = 10'000'000;

struct Choices {
  Names scenarios, rigs;
};

/// Reads a list of names and checks that they are different.
Names list(TomlTable& root, const std::string& key) {
  Names names = root.texts(key);
  if (root.has(key) && names.empty()) root.problem(key, "must not be empty");
  std::set<std::string> seen;
  for (const auto& name : names)
    if (!seen.insert(name).second) root.problem(key, "has " + name + " twice");
  return names;
}

Choices read_choices(TomlTable& root, Sweep& sweep) {
  Choices choices;
  sweep.description = root.text("description", "");
  if (!root.has("scenarios")) root.problem("scenarios", "must list at least one scenario");
  choices.scenarios = list(root, "scenarios");
  choices.rigs = list(root, "rigs");
  const Names methods{simulator::kMethodNames.begin(), simulator::kMethodNames.end()};
  sweep.integrator = simulator::method_named(root.choice("integrator", methods, methods.front()));
  sweep.variants = list(root, "variants");
  for (const auto& names : sweep.variants)
    for (const auto& problem : experiment::variant_problems(names)) root.problem("variants", problem);
  sweep.controllers = list(root, "controllers");
  if (sweep.controllers == Names{"all"}) sweep.controllers = configuration::controller_names();
  for (const auto& name : sweep.controllers)
    if (control::find_controller(name) == nullptr)
      root.problem("controllers", "no controller has the name " + name);
  return choices;
}

void read_seeds(TomlTable& root, Sweep& sweep) {
  sweep.seeds = static_cast<std::uint64_t>(std::max(1, root.integer("seeds", 1, kMostSeeds, 1)));
  sweep.first_seed = static_cast<std::uint64_t>(std::max(0, root.integer("first_seed", 0, 1'000'000'000, 1)));
  std::set<std::string> seen;
  for (TomlTable& table : root.tables("draw")) {
    Draw draw{.key = table.text("key")};
    draw.place = table.place("key");
    draw.low = table.number("low", Range::any());
    draw.high = table.number("high", Range::any());
    if (draw.low >= draw.high) table.problem("low", "must be below high");
    if (!draw.key.empty() && !seen.insert(draw.key).second) table.problem("key", "has a [[draw]] already");
    sweep.draws.push_back(std::move(draw));
  }
  if (sweep.seeds > 1 && sweep.draws.empty() && root.has("seeds"))
    root.problem("seeds", "must be 1 without a [[draw]]: every seed would give the same run");
}

/// Collects the problems of several files.
class Problems {
 public:
  /// @return false when `read` has thrown its problems
  template <class Read>
  bool collect(const Read& read) {
    try {
      read();
      return true;
    } catch (const ConfigurationError& error) {
      for (const auto& problem : error.problems())
        if (std::find(lines_.begin(), lines_.end(), problem) == lines_.end()) lines_.push_back(problem);
      return false;
    }
  }
  void add(const std::string& line) { lines_.push_back(line); }
  void throw_if_any() const {
    if (!lines_.empty()) throw ConfigurationError(lines_);
  }

 private:
  std::vector<std::string> lines_;
};

void load_cases(const Choices& choices, const Finder& finder, Problems& problems, Sweep& sweep) {
  for (const auto& name : choices.scenarios) {
    experiment::Scenario defaults;
    std::filesystem::path path;
    const bool found = problems.collect([&] {
      path = finder.scenario(name);
      defaults = experiment::load_scenario(path);
    });
    if (!found) continue;
    Names rigs = choices.rigs;
    if (rigs.empty()) rigs.push_back(defaults.rig.empty() ? stack::kDefaultRig : defaults.rig);
    for (const auto& rig_name : rigs)
      problems.collect([&] {
        auto rig = configuration::load_rig(finder.rig(rig_name));
        auto scenario = experiment::load_scenario(path, &rig);
        sweep.cases.push_back({std::move(scenario), std::move(rig)});
      });
  }
}

/// Checks that both bounds of every draw are valid on every rig.
void check_draws(const Sweep& sweep, const std::string& file, Problems& problems) {
  std::set<std::string> reported;
  const auto report = [&](const std::string& line) {
    if (reported.insert(line).second) problems.add(line);
  };
  for (const Case& on : sweep.cases) {
    Rig low = experiment::with_start_of(on.rig, on.scenario), high = low;
    for (const Draw& draw : sweep.draws) {
      const Number number = number_of(low, draw.key);
      if (number.value == nullptr) {
        report(draw.place + "draw.key = " + draw.key + ": the rig " + on.rig.name +
               " has no such number in [plant], [start] or [[model.terms]]");
        continue;
      }
      for (const double value : {draw.low, draw.high})
        if (!number.range.contains(value))
          report(draw.place + fields::complaint("draw " + draw.key, value, number.range.rule()));
      *number.value = draw.low;
      *number_of(high, draw.key).value = draw.high;
    }
    for (const Rig* rig : {&low, &high})
      for (const auto& problem : simulator::simulated_rig_of(*rig).problems())
        report(file + ":1: rig " + on.rig.name + ", scenario " + on.scenario.name +
               ", an end of the draws: " + problem);
  }
}

void check_controllers(const Sweep& sweep, Problems& problems) {
  std::set<std::string> seen;
  for (const Case& on : sweep.cases) {
    if (!seen.insert(on.rig.path).second) continue;
    for (const auto& controller : sweep.controllers)
      problems.collect([&] { (void)runtime::chosen_controller(controller, on.rig); });
  }
}

}  // namespace

std::size_t Sweep::size() const {
  return cases.size() * variants.size() * controllers.size() * static_cast<std::size_t>(seeds);
}

Sweep parse_sweep(const std::string& text, const std::string& file, const Finder& finder) {
  TomlTable root{text, file};
  Sweep sweep;
  sweep.name = std::filesystem::path{file}.stem().string();
  const Choices choices = read_choices(root, sweep);
  read_seeds(root, sweep);
  Problems problems;
  const bool readable = problems.collect([&] { root.finish(); });
  load_cases(choices, finder, problems, sweep);
  if (sweep.variants.empty()) sweep.variants.emplace_back();
  if (sweep.controllers.empty()) sweep.controllers.emplace_back();
  if (readable) {
    check_draws(sweep, file, problems);
    check_controllers(sweep, problems);
  }
  if (sweep.size() > kMostRuns)
    problems.add(file + ":1: " + std::to_string(sweep.size()) + " runs: must be at most " +
                 std::to_string(kMostRuns));
  problems.throw_if_any();
  return sweep;
}

Sweep load_sweep(const std::filesystem::path& file, const Finder& finder) {
  return parse_sweep(configuration::file_text(file), file.string(), finder);
}

}  // namespace crane::sweep
