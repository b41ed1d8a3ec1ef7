/// Scores the diagnosis on data with hidden effects: what it says about every cause, about clean data and
/// about effects it does not know. Not a test: prints a table.
///   bench_diagnosis --seeds 1 --amplitude 1 --first-seed 7
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>

#include "crane/diagnosis/diagnosis.hpp"
#include "truth/truth.hpp"

namespace {

using namespace crane::diagnosis;

struct Options {
  int seeds = 1;
  std::uint64_t first_seed = 7;
  double amplitude = 1;
  std::vector<std::string> only;
};

std::vector<Run> loaded(const std::vector<truth::Run>& runs, const crane::runtime::Rig& rig) {
  std::vector<Run> all;
  for (const truth::Run& run : runs)
    for (Run& piece : load_run(crane::recording::parse_csv(truth::csv(run), run.file), rig, run.file).runs)
      all.push_back(std::move(piece));
  return all;
}

/// "exact", "among" (ambiguous, the truth among them), "beside" (named with another one), "wrong", "none",
/// "unknown".
std::string judged(const Diagnosis& found, const std::string& hidden, bool in_library) {
  if (found.verdict == Verdict::none) return hidden.empty() ? "right" : "none";
  if (found.verdict == Verdict::unknown) return in_library || hidden.empty() ? "unknown" : "right";
  if (hidden.empty() || !in_library) return "wrong";
  bool there = false;
  for (const Cause& cause : found.causes) there = there || cause.name == hidden;
  if (found.verdict == Verdict::ambiguous) {
    for (const std::string& rival : found.ambiguous_with) there = there || rival == hidden;
    return there ? "among" : "wrong";
  }
  return !there ? "wrong" : found.causes.size() == 1 ? "right" : "beside";
}

void report(const std::string& what, std::uint64_t seed, const Diagnosis& found, const std::string& verdict,
            double seconds) {
  std::cout << std::left << std::setw(30) << what << std::setw(6) << seed << std::setw(9) << verdict
            << std::setw(10) << name_of(found.verdict) << std::right << std::fixed << std::setprecision(2)
            << std::setw(7) << found.held_out.gain << std::setw(7) << std::setprecision(1) << seconds << "  ";
  for (const Cause& cause : found.causes) {
    std::cout << cause.name << (cause.axis.empty() ? "" : "@" + cause.axis) << ' ';
    std::cout << std::defaultfloat << std::setprecision(4);
    for (const Estimate& e : cause.parameters)
      std::cout << e.name << '=' << e.value << "+-" << e.std_dev << ' ';
  }
  for (const std::string& rival : found.ambiguous_with) std::cout << "or " << rival << ' ';
  std::cout << std::endl;
}

void score(const Options& options) {
  const crane::runtime::Rig rig =
      crane::runtime::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
  std::vector<std::pair<std::string, bool>> effects{{"", true}};
  for (const truth::EffectKind& kind : truth::effect_kinds())
    effects.emplace_back(kind.name, kind.in_library);
  std::cout << "hidden                        seed  judged   verdict      gain      s  found\n";
  std::map<std::string, int> counts;
  for (const auto& [name, in_library] : effects) {
    if (!options.only.empty() &&
        std::find(options.only.begin(), options.only.end(), name) == options.only.end())
      continue;
    for (int i = 0; i < options.seeds; ++i) {
      truth::Case request;
      request.seed = options.first_seed + static_cast<std::uint64_t>(i);
      if (!name.empty()) request.effects = {{name, options.amplitude, ""}};
      try {
        const truth::Data data = truth::generate(request);
        const auto begin = std::chrono::steady_clock::now();
        const Diagnosis found = diagnose(rig, loaded(data.training, rig), loaded(data.test, rig));
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        const std::string verdict = judged(found, name, in_library);
        ++counts[verdict];
        const std::string axis = data.answer.empty() ? "" : data.answer[0].axis;
        report(name.empty() ? "(clean)" : name + (axis.empty() ? "" : "@" + axis), request.seed, found,
               verdict, took.count());
      } catch (const std::exception& error) {
        ++counts["no data"];
        std::cout << name << ": " << error.what() << '\n';
      }
    }
  }
  for (const auto& [verdict, count] : counts) std::cout << verdict << ' ' << count << "  ";
  std::cout << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Scores the diagnosis on data with hidden effects"};
  app.add_option("--seeds", options.seeds, "data sets per effect")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--first-seed", options.first_seed)->capture_default_str();
  app.add_option("--amplitude", options.amplitude, "multiple of a clearly visible effect")
      ->capture_default_str();
  app.add_option("--only", options.only, "effects; all when left out");
  CLI11_PARSE(app, argc, argv);
  score(options);
}
