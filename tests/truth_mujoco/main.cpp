/// `crane-truth-mujoco`: writes sets of a deck.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "write.hpp"

int main(int argc, char** argv) {
  mujoco_truth::Deck deck;
  std::size_t first = 0, count = 1;
  std::filesystem::path out = "deck", truth;
  bool alike = false;
  CLI::App app{
      "Writes measured data with hidden faults, of cranes that are rigid bodies in MuJoCo:\n"
      "out/set_NNNN/{rig.toml,train_N.csv,test_N.csv,truth.json}. Existing sets are not written again."};
  app.add_option("--deck", deck.name, "name of the deck; part of the seed")->capture_default_str();
  app.add_option("--seed", deck.seed, "seed of the deck")->capture_default_str();
  app.add_option("--first", first, "number of the first set")->capture_default_str();
  app.add_option("--sets", count, "number of sets")->capture_default_str();
  app.add_option("--out", out, "directory")->capture_default_str();
  app.add_option("--truth", truth,
                 "directory of the answers, set_NNNN.json; default: truth.json beside the data");
  app.add_flag("--alike", alike,
               "also name the faults that change these data in the same way; takes three times as long");
  CLI11_PARSE(app, argc, argv);
  try {
    for (std::size_t number = first; number < first + count; ++number) {
      std::array<char, 32> name{};
      std::snprintf(name.data(), name.size(), "set_%04zu", number);
      const std::filesystem::path directory = out / name.data();
      const auto answer =
          truth.empty() ? directory / "truth.json" : truth / (std::string{name.data()} + ".json");
      if (!std::filesystem::exists(answer)) write(made(deck, number, alike), directory, answer);
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "crane-truth-mujoco: " << error.what() << '\n';
    return 1;
  }
}
