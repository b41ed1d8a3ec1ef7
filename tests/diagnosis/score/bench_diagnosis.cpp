/// `crane bench diagnosis`: scores the diagnosis on data with hidden causes. Not a test: prints tables.
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <set>

#include "crane/workers/process_pool.hpp"
#include "score/mujoco_case.hpp"
#include "score/score_record.hpp"

namespace {

using namespace crane::diagnosis::score;

/// Longest processor time of a set in s; a set that takes longer has failed.
constexpr rlim_t kMostCpu_s = 600;

struct Options {
  std::string deck = "truth";
  std::size_t sets = 12;
  std::uint64_t first_seed = 100'000;
  std::size_t processes = 2;
  std::string results = "diagnosis_score.jsonl";
  std::string only;
  bool quiet = false;
};

/// Each set of tests/truth has a seed, counted from the first one; sets of MuJoCo have the seed of the deck.
std::uint64_t seed_of(const Options& options, std::size_t number) {
  return options.deck == "truth" ? options.first_seed + number : options.first_seed;
}

std::vector<std::size_t> missing(const Options& options) {
  std::set<std::size_t> done;
  for (const Record& record : read_records(options.results)) {
    if (record.seed != seed_of(options, record.number) || record.deck != options.deck)
      throw std::runtime_error(options.results + ": set " + std::to_string(record.number) +
                               " is of another --deck or --first-seed");
    done.insert(record.number);
  }
  std::vector<std::size_t> todo;
  for (std::size_t i = 0; i < options.sets; ++i)
    if (!done.contains(i)) todo.push_back(i);
  return todo;
}

void append_score(const Options& options, std::size_t number) {
  if (options.deck == "mujoco") {
    const Record record = scored_mujoco(number, options.first_seed);
    if (options.only.empty() || options.only == record.kind) append(options.results, record);
    return;
  }
  const Set set = set_of(number, options.first_seed);
  if (options.only.empty() || options.only == name_of(set.kind)) append(options.results, scored(set));
}

Record failed(const Options& options, std::size_t number, const std::string& failure) {
  Record record;
  record.deck = options.deck;
  record.number = number;
  record.seed = seed_of(options, number);
  record.kind =
      options.deck == "truth" ? name_of(set_of(number, options.first_seed).kind) : kind_of_mujoco(number);
  record.multiple = 1;
  record.judged = "failed";
  record.verdict = record.found = failure;
  return record;
}

/// Runs in the process of one set: a crash or an endless search affects only this set.
void score_one(const Options& options, std::size_t number) {
  const rlimit most{kMostCpu_s, kMostCpu_s};
  ::setrlimit(RLIMIT_CPU, &most);
  try {
    append_score(options, number);
  } catch (const std::exception& error) {
    std::cerr << "bench_diagnosis: set " << number << ": " << error.what() << '\n';
    throw;
  }
}

int score(const Options& options) {
  const std::vector<std::size_t> todo = missing(options);
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  std::size_t done = 0;
  int worst = 0;
  crane::workers::run(
      {.count = todo.size(),
       .at_a_time = options.processes,
       .work = [&](std::size_t i, const crane::workers::Outbox&) { score_one(options, todo[i]); },
       .take = [](std::size_t, const std::string&) {},
       .ended =
           [&](std::size_t i, const std::string& failure) {
             if (!failure.empty()) {
               append(options.results, failed(options, todo[i], failure));
               worst = 1;
             }
             if (terminal) std::fprintf(stderr, "\r%zu of %zu sets ", ++done, todo.size());
           }});
  if (terminal && !todo.empty()) std::fprintf(stderr, "\n");
  std::cout << table_of(read_records(options.results), options.quiet);
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Diagnose generated data with known, hidden causes, and print the table of targets. The generators\n"
      "share no code with the diagnosis. Each set adds one JSON line to the file of --results; sets that "
      "the\n"
      "file already contains are omitted, so that a run can be interrupted, continued and extended.",
      "crane bench diagnosis"};
  app.add_option(
         "--deck", options.deck,
         "truth: cranes of tests/truth; mujoco: cranes of tests/truth_mujoco, with widely varied conditions")
      ->check(CLI::IsMember({"truth", "mujoco"}))
      ->capture_default_str();
  app.add_option(
         "--sets", options.sets,
         "total number of sets. Of 12 sets of truth, 3 are clean, 6 have one cause, 1 a pair, 1 a cause "
         "outside the library, 1 confounded causes; of 20 sets of mujoco 5, 9, 2, 2 and 2")
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed,
                 "truth: seed of set 0, set k has this seed plus k; mujoco: seed of the deck")
      ->capture_default_str();
  app.add_option("--processes", options.processes, "number of sets at the same time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--results", options.results,
                 "file with one JSON line per set; sets that it contains are not repeated")
      ->capture_default_str();
  app.add_flag("--quiet", options.quiet, "print only the tables, no lines of single sets");
  app.add_option("--only", options.only, "diagnose only sets of this kind")
      ->check(CLI::IsMember({"clean", "single", "outside", "pair", "confounded"}));
  app.footer(
      "Examples: crane bench diagnosis --sets 1200 --results score.jsonl\n"
      "          crane bench diagnosis --sets 0 --results score.jsonl        only prints the tables");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    return score(options);
  } catch (const std::exception& error) {
    std::cerr << "bench_diagnosis: " << error.what() << '\n';
    return 1;
  }
}
