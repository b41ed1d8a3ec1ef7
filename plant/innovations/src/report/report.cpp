#include "crane/innovations/report.hpp"

#include <fstream>

#include "crane/diagnosis/report.hpp"
#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out{file, std::ios::binary};
  out << text;
  out.close();
  if (!out) throw diagnosis::ReportError(file.string() + ": cannot be written");
}

}  // namespace

nlohmann::ordered_json to_json(const Result& result) {
  auto json = diagnosis::to_json(result.diagnosis);
  auto& more = json["innovations"];
  more["held_out_nats"] = result.held_out_nats;
  more["held_out_nats_ci95"] = result.held_out_nats_ci95;
  more["refused"] = result.refused;
  more["leftover_p_value"] = result.leftover_p_value;
  more["leftover"] = nlohmann::ordered_json::array();
  for (const LeftoverLaw& law : result.leftover)
    more["leftover"].push_back({{"from", law.from},
                                {"gain_nats", law.gain_nats},
                                {"share", law.share},
                                {"force_rms", law.force_rms}});
  more["rules"] = nlohmann::ordered_json::array();
  for (const Rule& r : kRules)
    more["rules"].push_back({{"name", r.name},
                             {"value", r.value},
                             {"unit", r.unit},
                             {"meaning", r.meaning},
                             {"source", r.source},
                             {"level", r.level}});
  return json;
}

void write_report(const std::filesystem::path& directory, const Result& result, const runtime::Rig& rig) {
  write(directory / "report.json", to_json(result).dump(2) + "\n");
  write(directory / "extended.toml", diagnosis::extended_rig_text(rig, result.diagnosis));
}

}  // namespace crane::innovations
