// A rig that is written as TOML reads back as the same rig, bit for bit.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>

#include "crane/configuration/rig_fields.hpp"
#include "crane/plant/term.hpp"

namespace crane::configuration {
namespace {

/// A random number of the range: near the old value, on a logarithmic scale, or an end of the range.
double random_number(std::mt19937& random, const Range& range, double now) {
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  const double most = std::isfinite(range.high) ? range.high : 1e6;
  switch (random() % 4) {
    case 0:
      return now * uniform(0.5, 2);
    case 1:
      return now + uniform(-0.1, 0.1);
    case 2:
      return std::isfinite(range.low) && range.low > 0 ? range.low * std::pow(most / range.low, uniform(0, 1))
                                                       : uniform(std::max(range.low, -most), most);
    default:
      return random() % 2 == 0 ? std::max(range.low, -most) : most;
  }
}

/// Gives one field a random value.
template <class Section>
struct Randomize {
  std::mt19937& random;
  const Field<Section>& field;
  Section& section;

  void operator()(double Section::*member) const {
    section.*member = random_number(random, field.range, section.*member);
  }
  void operator()(const Element<Section>& element) const {
    double& value = (section.*element.array)[element.index];
    value = random_number(random, field.range, value);
  }
  void operator()(int Section::*member) const {
    const auto low = static_cast<int>(field.range.low), high = static_cast<int>(field.range.high);
    section.*member = std::uniform_int_distribution<int>{low, high}(random);
  }
  void operator()(bool Section::*member) const { section.*member = random() % 2 == 0; }
  void operator()(std::string Section::*member) const {
    const std::vector<std::string> texts{"a", "with \"quotes\" and \\", "line\nbreak", "\u00e4 # = [",
                                         "/dev/comedi1"};
    section.*member = texts[random() % texts.size()];
  }
  void operator()(const AxisSet<Section>& set) const {
    for (bool& member : section.*set.member) member = random() % 2 == 0;
  }
  void operator()(const Choice<Section>& choice) const {
    choice.set(section, random() % choice.names().size());
  }
};

void change_terms(std::mt19937& random, Rig& rig) {
  const auto& kinds = plant::term_kinds();
  const plant::TermKind& kind = kinds[random() % kinds.size()];
  plant::TermSetting term{.name = std::string{kind.name},
                          .axis = std::string{kind.axes[random() % kind.axes.size()]},
                          .parameters = {}};
  for (const auto& parameter : kind.parameters)
    if (random() % 2 == 0)
      term.parameters[std::string{parameter.name}] =
          random_number(random, Range::closed(parameter.low, parameter.high), parameter.default_value);
  if (rig.terms.size() > 3) rig.terms.clear();
  rig.terms.push_back(std::move(term));
}

void change_zones(std::mt19937& random, Rig& rig) {
  if (rig.zones.size() > 2) rig.zones.clear();
  control::Zone zone;
  for (const auto& field : control::kZoneFields)
    std::visit(Randomize<control::Zone>{random, field, zone}, field.member);
  zone.name += std::to_string(random());
  (zone.shape == control::ZoneShape::box ? zone.radius_m : zone.size_x_m) = 0;
  if (zone.shape == control::ZoneShape::cylinder) zone.size_y_m = 0;
  // A random position of a zone would nearly always contradict the rig. This position is beside the start of
  // each rig.
  zone.position_x_m = rig.start.position[0] + rig.clearance.load_radius_m + 0.3;
  zone.position_y_m = 0;
  zone.size_x_m = zone.size_y_m = zone.shape == control::ZoneShape::box ? 0.01 : 0;
  zone.radius_m = zone.shape == control::ZoneShape::box ? 0 : 0.01;
  zone.top_m = zone.bottom_m + 2000;
  rig.zones.push_back(std::move(zone));
}

/// Changes one field of the rig. @return its path, "" for terms and zones
std::string change_one(std::mt19937& random, Rig& rig) {
  std::size_t count = 0;
  for_each_section(rig, [&count](const auto&, const auto& fields, auto&, auto) { count += fields.size(); });
  std::size_t chosen = random() % (count + 7);
  if (chosen >= count + 5) {
    change_zones(random, rig);
    return {};
  }
  if (chosen >= count) {
    change_terms(random, rig);
    return {};
  }
  std::string changed;
  const auto visit = [&]<class Section, std::size_t N>(
                         const std::string& path, const std::array<Field<Section>, N>& fields,
                         std::type_identity_t<Section>& section, std::string_view unit) {
    if (changed.empty() && chosen < N) {
      changed = path + '.' + key_of(fields[chosen], unit);
      std::visit(Randomize<Section>{random, fields[chosen], section}, fields[chosen].member);
    }
    chosen -= std::min(chosen, N);
  };
  for_each_section(rig, visit);
  return changed;
}

Rig read_back(const Rig& rig) { return parse_rig(to_toml(rig), rig.path); }

/// Updates the values of the design that follow from changed fields. The file contains homing only for an
/// axis that homes, and a channel only for an encoder that exists.
Rig with_what_follows(Rig rig, const Rig& read) {
  rig.design.period_s = read.design.period_s;
  rig.design.shortest_cable_length_m = read.design.shortest_cable_length_m;
  rig.design.longest_cable_length_m = read.design.longest_cable_length_m;
  rig.design.volt_limit_v = read.design.volt_limit_v;
  for (Drive& drive : rig.drives)
    if (!drive.homes()) drive.homing = {};
  for (Encoder& encoder : rig.encoders)
    if (encoder.counts_per_unit == 0) encoder = {};
  return rig;
}

class RoundTrip : public testing::TestWithParam<const char*> {};

/// One random change of the rig. A change that contradicts other fields is refused and reverted.
TEST_P(RoundTrip, GivesTheSameRigForAnyRig) {
  constexpr unsigned kSeed = 20250117;
  constexpr int kChanges = 1500;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random{kSeed};
  Rig rig = load_rig(std::filesystem::path{CRANE_RIGS} / GetParam());
  int accepted = 0;
  for (int i = 0; i < kChanges; ++i) {
    Rig changed = rig;
    const auto path = change_one(random, changed);
    Rig read;
    try {
      read = read_back(changed);
    } catch (const ConfigurationError&) {
      continue;
    }
    changed = with_what_follows(std::move(changed), read);
    ASSERT_TRUE(read == changed) << path << " after " << i << " changes\n"
                                 << to_toml(changed) << to_toml(read);
    ASSERT_EQ(to_toml(read), to_toml(changed)) << path;  // also compares the sign of 0
    rig = std::move(changed);
    ++accepted;
  }
  RecordProperty("accepted", accepted);
  EXPECT_GT(accepted, kChanges / 4);
}

INSTANTIATE_TEST_SUITE_P(Deployed, RoundTrip,
                         testing::Values("virginia_tech_tower.toml", "gantry.toml", "drive_axis.toml",
                                         "pendulum.toml", "homing_servo_to_go.toml"),
                         [](const auto& test) {
                           const std::string file = test.param;
                           return file.substr(0, file.find('.'));
                         });

TEST(RoundTripOfDeployedRigs, ChangesNothing) {
  for (const auto& entry : std::filesystem::directory_iterator(CRANE_RIGS)) {
    if (entry.path().extension() != ".toml") continue;
    const Rig rig = load_rig(entry.path());
    EXPECT_TRUE(read_back(rig) == rig) << entry.path();
  }
}

TEST(RigEquality, ComparesEveryFieldOfTheFile) {
  const Rig rig = load_rig(std::filesystem::path{CRANE_RIGS} / "homing_servo_to_go.toml");
  std::mt19937 random{1};
  Rig copy = rig;
  const auto visit = [&]<class Section, std::size_t N>(
                         const std::string& path, const std::array<Field<Section>, N>& fields,
                         std::type_identity_t<Section>& section, std::string_view) {
    for (const auto& field : fields) {
      const Section before = section;
      // A random value may equal the old value.
      for (int i = 0; i < 20 && section == before; ++i)
        std::visit(Randomize<Section>{random, field, section}, field.member);
      EXPECT_FALSE(copy == rig) << path << ' ' << field.key;
      section = before;
    }
  };
  for_each_section(copy, visit);
}

}  // namespace
}  // namespace crane::configuration
