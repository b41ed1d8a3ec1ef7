#pragma once
/// All data of the dashboard, updated sample by sample. Used by the network thread only.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "crane/bus/bus.hpp"
#include "dashboard/foxglove.hpp"
#include "dashboard/operator_seat.hpp"
#include "dashboard/situation.hpp"
#include "observation/fault_timeline.hpp"
#include "observation/history.hpp"
#include "observation/traffic.hpp"

namespace crane::dashboard {

/// Start options of the dashboard.
struct About {
  std::string version, crane;
  std::uint32_t domain = 0;
  std::string rig;  ///< JSON text of the rig's geometry; empty: unknown
  /// Of the planner, by axis, m/s² or rad/s²; 0: unknown.
  std::array<double, 3> reference_acceleration{};
};

class Model {
 public:
  explicit Model(About about) : about_{std::move(about)} {}

  void add(const observation::SamplePtr& sample);
  /// Stores the programs of this crane whose messages have another version; their samples are dropped.
  void set_other_versions(std::vector<bus::OtherVersion> others) { other_versions_ = std::move(others); }
  /// Updates the documents. @return the documents that have changed
  [[nodiscard]] std::vector<Document> poll(std::int64_t now_ns, std::int64_t log_now_ns);
  /// JSON text of a document.
  [[nodiscard]] const std::string& text(Document document) const {
    return documents_[static_cast<std::size_t>(document)];
  }

  [[nodiscard]] const About& about() const { return about_; }
  [[nodiscard]] const observation::History& history() const { return history_; }
  [[nodiscard]] const observation::Traffic& traffic() const { return traffic_; }
  [[nodiscard]] const Situation& situation() const { return situation_; }
  [[nodiscard]] const observation::FaultTimeline& faults() const { return faults_; }
  [[nodiscard]] const std::vector<bus::OtherVersion>& other_versions() const { return other_versions_; }
  [[nodiscard]] OperatorSeat& seat() { return seat_; }

 private:
  [[nodiscard]] nlohmann::ordered_json traffic_json(std::int64_t now_ns) const;
  bool replace(Document document, const nlohmann::ordered_json& json);

  About about_;
  observation::History history_;
  observation::Traffic traffic_;
  Situation situation_;
  observation::FaultTimeline faults_;
  OperatorSeat seat_;
  std::vector<bus::OtherVersion> other_versions_;
  std::array<std::string, kDocuments> documents_;
};

}  // namespace crane::dashboard
