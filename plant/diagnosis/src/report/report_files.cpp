#include <sstream>

#include "crane/configuration/extended_file.hpp"
#include "crane/diagnosis/report.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/recording/csv.hpp"

namespace crane::diagnosis {
std::string extended_rig_text(const configuration::Rig& rig, const Diagnosis& diagnosis) {
  std::ostringstream out;
  out << "# " << rig.name << ", extended by the terms that `crane diagnose` found. " << diagnosis.sentence
      << '\n'
      << "extends = "
      << configuration::toml_string(std::filesystem::absolute(rig.path).lexically_normal().string())
      << "\nname = " << configuration::toml_string(rig.name + "_extended") << '\n';
  // The array of the extending file replaces that of the base: it repeats the rig's own terms.
  std::vector<plant::TermSetting> terms = rig.terms;
  terms.insert(terms.end(), diagnosis.extension.begin(), diagnosis.extension.end());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    out << '\n'
        << (i == rig.terms.size() ? "# Found by crane diagnose.\n" : "") << "[[model.terms]]\nname = \""
        << terms[i].name << "\"\n";
    if (!terms[i].axis.empty()) out << "axis = \"" << terms[i].axis << "\"\n";
    for (const auto& [name, value] : terms[i].parameters)
      out << name << " = " << recording::shortest(value) << '\n';
  }
  return out.str();
}

void write_report(const std::filesystem::path& directory, const Diagnosis& diagnosis,
                  const configuration::Rig& rig, const std::vector<Run>& test) {
  files::write_file(directory / "report.json", to_json(diagnosis).dump(2) + "\n");
  files::write_file(directory / "extended.toml", extended_rig_text(rig, diagnosis));
  const auto experiment = directory / "next_experiment.toml";
  std::error_code ignored;
  std::filesystem::remove(experiment, ignored);  // of an earlier diagnosis
  if (diagnosis.next_experiment) files::write_file(experiment, diagnosis.next_experiment->scenario);
  report::write_html(directory / "report.html", report_page(diagnosis, rig, test));
}

}  // namespace crane::diagnosis
