#include "dashboard/model.hpp"

#include <nlohmann/json.hpp>

namespace crane::dashboard {

void Model::add(const observation::SamplePtr& sample) {
  history_.add(sample);
  traffic_.add(*sample);
  situation_.add(*sample);
  faults_.add(*sample);
}

std::vector<Document> Model::poll(std::int64_t now_ns, std::int64_t log_now_ns) {
  std::vector<Document> changed;
  const auto update = [&](Document document, const nlohmann::ordered_json& json) {
    if (replace(document, json)) changed.push_back(document);
  };
  update(Document::situation, situation_.json(now_ns));
  if (traffic_.poll(now_ns)) update(Document::traffic, traffic_json(now_ns));
  if (faults_.poll(now_ns, log_now_ns, traffic_, history_) || text(Document::faults).empty())
    update(Document::faults, faults_.json());
  const auto holder = seat_.holder(now_ns);
  update(Document::seat,
         {{"operator", holder ? nlohmann::ordered_json(*holder) : nlohmann::ordered_json(nullptr)}});
  return changed;
}

nlohmann::ordered_json Model::traffic_json(std::int64_t now_ns) const {
  auto json = traffic_.json(now_ns);
  json["other_versions"] = nlohmann::ordered_json::array();
  for (const auto& other : other_versions_)
    json["other_versions"].push_back({{"participant", other.participant},
                                      {"version", other.version},
                                      {"explanation", bus::refusal(other)}});
  return json;
}

bool Model::replace(Document document, const nlohmann::ordered_json& json) {
  auto text = text_of(json);
  auto& kept = documents_[static_cast<std::size_t>(document)];
  if (text == kept) return false;
  kept = std::move(text);
  return true;
}

}  // namespace crane::dashboard
