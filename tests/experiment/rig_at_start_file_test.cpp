#include "experiments/rig_at_start_file.hpp"

#include <gtest/gtest.h>

#include "crane/experiment/scenario.hpp"
#include "crane/experiment/variant.hpp"
#include "stack/data_files.hpp"

namespace crane::experiments {
namespace {

class StartedRigFile : public testing::TestWithParam<std::string> {};

/// The processes must read the rig that the components in one process get.
TEST_P(StartedRigFile, ReadsBackAsTheRigThatRuns) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  experiment::Scenario scenario;
  scenario.start = {0.7, 0.1, {}};
  scenario.swing_radial_rad = 0.05;
  scenario.load_mass_kg = 3;
  scenario.cable_length_offset_m = 0.2;
  const auto started = experiment::changed_by(experiment::with_start_of(rig, scenario), GetParam());
  const auto file = std::filesystem::path{testing::TempDir()} / ("started_" + GetParam() + ".toml");
  write_rig_at_start(file, started);
  auto read = configuration::load_rig(file);
  std::filesystem::remove(file);
  read.path = started.path;
  EXPECT_TRUE(read == started) << configuration::to_toml(read) << configuration::to_toml(started);
}

std::vector<std::string> every_variant() {
  std::vector<std::string> names{""};
  for (const auto& variant : experiment::variants()) names.emplace_back(variant.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Variants, StartedRigFile, testing::ValuesIn(every_variant()), [](const auto& test) {
  std::string name = test.param.empty() ? "none" : test.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace
}  // namespace crane::experiments
