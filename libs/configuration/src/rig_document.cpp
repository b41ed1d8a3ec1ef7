#include "crane/configuration/rig_document.hpp"

#include "crane/configuration/rig_fields.hpp"
#include "crane/fields/shortest.hpp"
#include "rig_sections.hpp"
#include "section_reader.hpp"

namespace crane::configuration {
namespace {

std::string listed_in_code(const std::vector<std::string>& names, const char* separator) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "`" : separator + std::string{"`"}) + name + '`';
  return text;
}

/// "required with trolley"
std::string requirement(Presence presence) {
  switch (presence) {
    case Presence::optional:
      return {};
    case Presence::required:
      return "required";
    case Presence::required_with_load:
      return "required with load";
    case Presence::required_with_trolley:
      return "required with trolley";
    case Presence::required_with_slew:
      return "required with slew";
    case Presence::required_with_hoist:
      return "required with hoist";
  }
  return {};
}

/// Range and default of one field, as the document prints them.
template <class Section>
struct FieldText {
  const Field<Section>& field;
  const Section& initial;

  struct Text {
    std::string range, preset;
  };
  Text operator()(double Section::*member) const {
    return {field.range.interval(), fields::shortest(initial.*member)};
  }
  Text operator()(const Element<Section>& element) const {
    return {field.range.interval(), fields::shortest((initial.*element.array)[element.index])};
  }
  Text operator()(int Section::*member) const {
    return {std::to_string(static_cast<int>(field.range.low)) + ".." +
                std::to_string(static_cast<int>(field.range.high)),
            std::to_string(initial.*member)};
  }
  Text operator()(bool Section::*member) const { return {"true, false", initial.*member ? "true" : "false"}; }
  Text operator()(std::string Section::*member) const {
    return {{}, (initial.*member).empty() ? std::string{} : '`' + initial.*member + '`'};
  }
  Text operator()(const AxisSet<Section>&) const { return {"of `trolley`, `slew`, `hoist`", {}}; }
  Text operator()(const Choice<Section>& choice) const {
    const auto names = choice.names();
    return {field.choices_text.empty() ? listed_in_code(names, ", ") : std::string{field.choices_text},
            '`' + names[choice.get(initial)] + '`'};
  }
};

/// The unit as the document prints it. When the key contains the unit, the document prints the unit of the
/// trolley.
template <class Section>
std::string unit_text(const Field<Section>& field) {
  constexpr std::array<std::string_view, 6> kOfMetres{"", "m", "m/s", "m/s²", "m/s³", "V per m/s"};
  return std::string{field.unit.empty() ? kOfMetres[static_cast<std::size_t>(field.quantity)] : field.unit};
}

/// A text as the cell of a table: a bar would end the cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string{"\\|"} : std::string{c};
  return escaped;
}

/// Not inlined: GCC 12 would warn about reads beyond the end of small sections.
template <class Section, std::size_t N>
[[gnu::noinline]] std::string rows(const std::array<Field<Section>, N>& fields, const Section& initial) {
  std::string text;
  for (const Field<Section>& field : fields) {
    const auto [range, preset] = std::visit(FieldText<Section>{field, initial}, field.member);
    const auto required = requirement(field.presence);
    const auto shown = !required.empty()             ? required
                       : !field.default_text.empty() ? std::string{field.default_text}
                                                     : preset;
    text += "| `" + key_of(field, "m") + "` | " + unit_text(field) + " | " + range + " | " + shown + " | " +
            cell(field.meaning) + " |\n";
  }
  return text;
}

template <class... Sections, std::size_t... N>
SectionTable section_table(std::string section, const std::array<Field<Sections>, N>&... tables) {
  return {std::move(section), "| key | unit | range | default | meaning |\n|---|---|---|---|---|\n" +
                                  (rows(tables, Sections{}) + ...)};
}

SectionTable boards_table() {
  std::string rows = "| `board` | meaning |\n|---|---|\n";
#define CRANE_BOARD(name, meaning) rows += "| `" #name "` | " meaning " |\n";
#include "crane/configuration/boards.def"
#undef CRANE_BOARD
  return {"board", rows + "| `simulated` | no hardware: for the simulated plant only |\n"};
}

}  // namespace

std::vector<SectionTable> section_tables() {
  return {boards_table(),
          section_table("rig", kRigFields),
          section_table("plant", plant::kParameterFields),
          section_table("drive", kDriveFields, control::kDriveLimitFields),
          section_table("encoder", kEncoderFields, kRestFields, kZeroFields),
          section_table("homing", kMarkFields, control::kHomingFields),
          section_table("wiring", kWiringFields),
          section_table("wiring of a drive", kDriveLineFields),
          section_table("sensing", kSensingFields),
          section_table("limits", control::kOperatingLimitFields),
          section_table("start", kStartFields),
          section_table("zone", control::kZoneFields),
          section_table("clearance", control::kClearanceFields),
          section_table("controller", kControllerFields, kPlanningFields, control::kDesignFields),
          section_table("controller.friction", control::kFrictionFields),
          section_table("adaptation", control::kAdaptationFields),
          {"implausible values", implausible_values()}};
}

std::string with_section_tables(const std::string& document) {
  std::string text = document;
  for (const auto& [section, markdown] : section_tables()) {
    const std::string begin = "<!-- fields of " + section + " -->\n";
    const auto found = text.find(begin);
    const auto end = found == std::string::npos ? found : text.find("<!-- end -->", found);
    if (end == std::string::npos)
      text += begin + markdown + "<!-- end -->\n";
    else
      text.replace(found + begin.size(), end - found - begin.size(), markdown);
  }
  return text;
}

}  // namespace crane::configuration
