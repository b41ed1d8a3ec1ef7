/// crane keys: authorities, identities and permissions for an open network.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <iostream>
#include <memory>

#include "cli/text_table.hpp"
#include "commands.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/runtime/process.hpp"
#include "crane/security/keys.hpp"

namespace crane::cli {
namespace {

std::string day_of(std::int64_t time_s) {
  const std::time_t time = time_s;
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

std::vector<security::Entry> entries_of(const std::string& directory) {
  auto entries = security::entries(directory);
  if (entries.empty())
    throw configuration::ConfigurationError(
        {directory + ": holds no identity; make keys with crane keys make " + directory});
  return entries;
}

int make_keys(const std::string& directory, int days) {
  security::make(directory, security::valid_for(days));
  std::cout << directory << ": keys for " << security::roles().size() << " roles, valid for " << days
            << " days\n"
            << "next: crane up --secure " << directory << ", and --secure " << directory
            << " for every tool\n"
            << "A host that only watches needs identity_ca.pem, permissions_ca.pem, governance.smime and "
               "monitor/.\n"
            << "Keep " << directory
            << "/private off the rig: everyone who has this directory can make keys of a supervisor.\n";
  return runtime::kExitDone;
}

int show_keys(const std::string& directory) {
  TextTable table{{"role", "for", "vendor", "subject", "valid until", "may write"}};
  for (const auto& entry : entries_of(directory)) {
    std::string writes;
    for (const auto topic : security::writes(*entry.role))
      writes += (writes.empty() ? "" : " ") + std::string{topic};
    table.add({std::string{entry.role->name}, std::string{entry.role->summary}, std::string{entry.vendor},
               entry.subject, day_of(entry.until_s), writes.empty() ? "nothing" : writes});
  }
  table.print(std::cout);
  std::cout << "Every role may read every topic of the crane.\n";
  return runtime::kExitDone;
}

int check_keys(const std::string& directory) {
  std::vector<std::string> problems;
  const auto entries = entries_of(directory);
  for (const auto& entry : entries)
    for (const auto& problem : entry.problems)
      if (std::find(problems.begin(), problems.end(), problem) == problems.end()) problems.push_back(problem);
  if (!problems.empty()) throw configuration::ConfigurationError(std::move(problems));
  std::cout << directory << ": " << entries.size() << " identities, all usable";
  if (const auto ends = security::ends(directory); !ends.empty())
    std::cout << " until " << security::utc_of(ends.front().until_s);
  std::cout << '\n';
  if (const auto warning = security::warning_of_end(directory, std::time(nullptr)); !warning.empty())
    std::cerr << warning << '\n';
  return runtime::kExitDone;
}

CLI::App* add_keys_command(CLI::App& keys, const char* name, const char* summary, std::string& directory) {
  auto* command = keys.add_subcommand(name, summary);
  command->footer("Example: crane keys " + std::string{name} + " keys");
  command->add_option("DIR", directory, "directory of keys")->required();
  return command;
}

}  // namespace

void add_keys(CLI::App& app, Action& chosen) {
  struct Options {
    std::string directory;
    int days = 3650;
  };
  auto options = std::make_shared<Options>();
  auto* keys = app.add_subcommand("keys", "Make, show and check the keys of a crane on an open network");
  keys->require_subcommand(1);
  keys->footer(
      "Example: crane keys make keys && crane up --secure keys --interface 192.0.2.7\n"
      "Without keys every program that reaches the bus can command the crane. With keys, only programs with "
      "a\n"
      "certificate of this crane's authority take part, each writes only the topics of its role (crane keys\n"
      "show DIR), and all traffic is encrypted and authenticated (docs/security.md).");
  auto* make = add_keys_command(*keys, "make", "Make the authorities and an identity for each role",
                                options->directory);
  make->add_option("--days", options->days, "validity of the certificates in days")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  make->callback(
      [options, &chosen] { chosen = [options] { return make_keys(options->directory, options->days); }; });
  auto* show = add_keys_command(*keys, "show",
                                "List the roles, the topics that each may write, and the end of validity",
                                options->directory);
  show->callback([options, &chosen] { chosen = [options] { return show_keys(options->directory); }; });
  auto* check = add_keys_command(*keys, "check", "Report problems of the keys: file, value, rule, remedy",
                                 options->directory);
  check->callback([options, &chosen] { chosen = [options] { return check_keys(options->directory); }; });
}

}  // namespace crane::cli
