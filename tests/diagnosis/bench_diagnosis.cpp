/// `crane bench diagnosis`: scores the diagnosis on data with hidden effects. Not a test: prints tables.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <set>
#include <thread>

#include "score_record.hpp"

namespace {

using namespace crane::diagnosis::score;

struct Options {
  std::size_t sets = 12;
  std::uint64_t first_seed = 100'000;
  int processes = 2;
  std::string results = "diagnosis_score.jsonl";
  std::string only;
};

std::vector<std::size_t> missing(const Options& options) {
  std::set<std::size_t> done;
  for (const Record& record : read_records(options.results)) {
    if (record.seed != options.first_seed + record.number)
      throw std::runtime_error(options.results + ": set " + std::to_string(record.number) +
                               " is of another --first-seed");
    done.insert(record.number);
  }
  std::vector<std::size_t> todo;
  for (std::size_t i = 0; i < options.sets; ++i)
    if (!done.contains(i)) todo.push_back(i);
  return todo;
}

/// Every `processes`-th of the sets, from the `rank`-th on.
int work(const Options& options, const std::vector<std::size_t>& todo, int rank) {
  try {
    for (std::size_t i = static_cast<std::size_t>(rank); i < todo.size();
         i += static_cast<std::size_t>(options.processes)) {
      const Set set = set_of(todo[i], options.first_seed);
      if (options.only.empty() || options.only == name_of(set.kind)) append(options.results, scored(set));
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_diagnosis: " << error.what() << '\n';
    return 1;
  }
}

/// Until all have ended; on a terminal it shows how many sets there are.
int wait_for(const std::vector<pid_t>& workers, const Options& options) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  int worst = 0;
  for (std::size_t running = workers.size(); running > 0;) {
    int status = 0;
    const pid_t ended = ::waitpid(-1, &status, terminal ? WNOHANG : 0);
    if (ended > 0) {
      --running;
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) worst = 1;
      continue;
    }
    std::fprintf(stderr, "\r%zu of %zu sets ", read_records(options.results).size(), options.sets);
    std::this_thread::sleep_for(std::chrono::seconds{1});
  }
  if (terminal) std::fprintf(stderr, "\n");
  return worst;
}

int score(const Options& options) {
  const auto todo = missing(options);
  std::vector<pid_t> workers;
  for (int rank = 0; rank < options.processes; ++rank) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      ::_exit(work(options, todo, rank));
    }
    if (child < 0) throw std::runtime_error("cannot start another process");
    workers.push_back(child);
  }
  const int worst = wait_for(workers, options);
  std::cout << table_of(read_records(options.results));
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Scores the diagnosis on data with hidden effects that share no code with it, and prints the table "
      "of targets.\nEvery set is appended to the file of results as one line of JSON; sets that are "
      "there are not computed again,\nso that a long score may be interrupted, continued and lengthened."};
  app.add_option("--sets", options.sets,
                 "how many in all; of twelve, 3 clean, 6 single, 1 pair, 1 outside, 1 alike")
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "of set 0; set k has the k-th after it")
      ->capture_default_str();
  app.add_option("--processes", options.processes, "sets under way at once")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--results", options.results, "file of results")->capture_default_str();
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
