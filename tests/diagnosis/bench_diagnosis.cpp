/// `crane bench diagnosis`: scores the diagnosis on data with hidden effects. Not a test: prints tables.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <deque>
#include <iostream>
#include <map>
#include <set>

#include "mujoco_case.hpp"
#include "score_record.hpp"

namespace {

using namespace crane::diagnosis::score;

/// Processor time after which a set has failed, s.
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

/// Sets of the truth have a seed each, counted from the first; those of MuJoCo have the deck's.
std::uint64_t seed_of(const Options& options, std::size_t number) {
  return options.deck == "truth" ? options.first_seed + number : options.first_seed;
}

std::deque<std::size_t> missing(const Options& options) {
  std::set<std::size_t> done;
  for (const Record& record : read_records(options.results)) {
    if (record.seed != seed_of(options, record.number) || record.deck != options.deck)
      throw std::runtime_error(options.results + ": set " + std::to_string(record.number) +
                               " is of another --deck or --first-seed");
    done.insert(record.number);
  }
  std::deque<std::size_t> todo;
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

/// One process per set: a crash affects no other set.
pid_t started(const Options& options, std::size_t number) {
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start another process");
  if (child > 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const rlimit most{kMostCpu_s, kMostCpu_s};
  ::setrlimit(RLIMIT_CPU, &most);
  try {
    append_score(options, number);
    ::_exit(0);
  } catch (const std::exception& error) {
    std::cerr << "bench_diagnosis: set " << number << ": " << error.what() << '\n';
    ::_exit(1);
  }
}

Record failed(const Options& options, std::size_t number, int status) {
  Record record;
  record.deck = options.deck;
  record.number = number;
  record.seed = seed_of(options, number);
  record.kind =
      options.deck == "truth" ? name_of(set_of(number, options.first_seed).kind) : kind_of_mujoco(number);
  record.multiple = 1;
  record.judged = "failed";
  record.verdict = record.found =
      WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status)) : "see the error output";
  return record;
}

/// A free worker takes the next set.
int score(const Options& options) {
  std::deque<std::size_t> todo = missing(options);
  const std::size_t all = todo.size();
  std::map<pid_t, std::size_t> running;
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  int worst = 0;
  while (!todo.empty() || !running.empty()) {
    if (!todo.empty() && running.size() < options.processes) {
      const pid_t child = started(options, todo.front());
      running[child] = todo.front();
      todo.pop_front();
      continue;
    }
    int status = 0;
    const pid_t ended = ::waitpid(-1, &status, 0);
    const auto of = running.find(ended);
    if (of == running.end()) throw std::runtime_error("lost a process");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      append(options.results, failed(options, of->second, status));
      worst = 1;
    }
    running.erase(of);
    if (terminal) std::fprintf(stderr, "\r%zu of %zu sets ", all - todo.size() - running.size(), all);
  }
  if (terminal && all > 0) std::fprintf(stderr, "\n");
  std::cout << table_of(read_records(options.results), options.quiet);
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Scores the diagnosis on data with hidden effects that share no code with it, and prints the table "
      "of targets.\nEvery set is appended to the file of results as one line of JSON; sets that are "
      "there are not computed again,\nso that a long score may be interrupted, continued and lengthened."};
  app.add_option("--deck", options.deck,
                 "truth: cranes of tests/truth; mujoco: those of tests/truth_mujoco, with wide nuisance")
      ->check(CLI::IsMember({"truth", "mujoco"}))
      ->capture_default_str();
  app.add_option("--sets", options.sets,
                 "how many in all; of twelve of the truth 3 clean, 6 single, 1 pair, 1 outside, 1 alike; of "
                 "twenty of MuJoCo 5, 9, 2, 2, 2")
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed,
                 "of set 0; set k has the k-th after it; of MuJoCo that of the deck")
      ->capture_default_str();
  app.add_option("--processes", options.processes, "sets under way at once")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--results", options.results, "file of results")->capture_default_str();
  app.add_flag("--quiet", options.quiet, "print nothing about single sets: a deck that is to stay unseen");
  app.add_option("--only", options.only, "sets of this kind only")
      ->check(CLI::IsMember({"clean", "single", "outside", "pair", "confounded"}));
  app.footer(
      "Example: bench_diagnosis --sets 1200 --results score.jsonl\n"
      "         bench_diagnosis --sets 0 --results score.jsonl        tables of what there is");
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
