#include <fstream>
#include <sstream>

#include "crane/diagnosis/report.hpp"
#include "crane/recording/csv.hpp"

namespace crane::diagnosis {
namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out{file, std::ios::binary};
  out << text;
  if (!out.flush()) throw ReportError(file.string() + ": cannot write");
}

/// A TOML basic string.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string extended_rig_text(const configuration::Rig& rig, const Diagnosis& diagnosis) {
  std::ostringstream out;
  out << "# " << rig.name << ", extended by the terms that `crane diagnose` found. " << diagnosis.sentence
      << '\n'
      << "extends = " << quoted_toml(std::filesystem::absolute(rig.path).lexically_normal().string())
      << "\nname = " << quoted_toml(rig.name + "_extended") << '\n';
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
  write_text(directory / "report.json", to_json(diagnosis).dump(2) + "\n");
  write_text(directory / "extended.toml", extended_rig_text(rig, diagnosis));
  const auto experiment = directory / "next_experiment.toml";
  std::error_code ignored;
  std::filesystem::remove(experiment, ignored);  // of an earlier diagnosis
  if (diagnosis.next_experiment) write_text(experiment, diagnosis.next_experiment->scenario);
  report::write_html(directory / "report.html", report_page(diagnosis, rig, test));
}

}  // namespace crane::diagnosis
