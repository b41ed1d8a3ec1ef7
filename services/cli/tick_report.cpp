#include "cli/tick_report.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "cli/text_table.hpp"
#include "observation/arrival_statistics.hpp"

namespace crane::cli {

using Json = nlohmann::ordered_json;

namespace {

/// Percentiles and mean of a quantity over all ticks, in us.
struct TickRow {
  double p50_us = 0, p99_us = 0, mean_us = 0;
};
TickRow row_of(const TickBreakdown& breakdown,
               const std::function<std::int64_t(const TickPath&)>& quantity_ns) {
  std::vector<double> values;
  double sum = 0;
  for (const auto& tick : breakdown.ticks) {
    values.push_back(static_cast<double>(quantity_ns(tick)) / 1e3);
    sum += values.back();
  }
  const auto spread = observation::spread(values);
  return {spread->p50, spread->p99, sum / static_cast<double>(values.size())};
}

/// Mean of the parts of one hop, over the ticks whose path contains it.
struct HopMean {
  std::string from, to;
  std::size_t ticks = 0;
  std::array<double, kParts> parts_us{};
};
std::vector<HopMean> hop_means(const TickBench& bench) {
  std::map<std::pair<std::size_t, std::size_t>, HopMean> means;
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (const auto& tick : bench.breakdown.ticks)
    for (const auto& hop : tick.hops) {
      auto [found, added] = means.try_emplace({hop.from, hop.to});
      if (added) {
        order.push_back(found->first);
        found->second.from = bench.processes[hop.from].name;
        found->second.to = bench.processes[hop.to].name;
      }
      ++found->second.ticks;
      for (std::size_t i = 0; i < kParts; ++i)
        found->second.parts_us[i] += static_cast<double>(hop.parts_ns[i]) / 1e3;
    }
  std::vector<HopMean> result;
  for (const auto& key : order) {
    auto& mean = means.at(key);
    for (auto& part_us : mean.parts_us) part_us /= static_cast<double>(mean.ticks);
    result.push_back(mean);
  }
  std::ranges::stable_sort(result, {}, [&](const HopMean& hop) {
    const auto index = [&](const std::string& name) {
      return std::ranges::find(bench.processes, name, &runtime::ComponentSpec::name) -
             bench.processes.begin();
    };
    return std::pair{index(hop.to) == 0, index(hop.from)};
  });
  return result;
}

Json json_of_threads(const ThreadShare& share) {
  return {{"running_us", share.running_us}, {"waiting_us", share.waiting_us}, {"runs", share.runs}};
}

}  // namespace

Json json_of(const TickBench& bench) {
  const auto& breakdown = bench.breakdown;
  const auto total = row_of(breakdown, [](const TickPath& tick) { return tick.latency_ns; });
  Json json{{"period_s", bench.period_s},
            {"priority", bench.priority},
            {"ticks", breakdown.ticks.size()},
            {"left_out", breakdown.left_out},
            {"state_to_command_us", {{"p50", total.p50_us}, {"p99", total.p99_us}, {"mean", total.mean_us}}}};
  for (std::size_t i = 0; i < kParts; ++i) {
    const auto row = row_of(breakdown, [i](const TickPath& tick) { return sum_of_hops(tick)[i]; });
    json["parts"].push_back({{"part", kPartNames[i]},
                             {"p50_us", row.p50_us},
                             {"p99_us", row.p99_us},
                             {"mean_us", row.mean_us},
                             {"share", row.mean_us / total.mean_us}});
  }
  for (const auto& hop : hop_means(bench)) {
    Json one{{"from", hop.from}, {"to", hop.to}, {"ticks", hop.ticks}};
    for (std::size_t i = 0; i < kParts; ++i) one["mean_us"][kPartNames[i]] = hop.parts_us[i];
    json["hops"].push_back(one);
  }
  for (const auto& floor : bench.floors) {
    const auto spread = observation::spread(floor.times_us);
    json["floors"].push_back({{"floor", floor.name},
                              {"fifo", floor.fifo},
                              {"samples", floor.times_us.size()},
                              {"p50_us", spread->p50},
                              {"p99_us", spread->p99},
                              {"ratio_p50", total.p50_us / spread->p50},
                              {"ratio_p99", total.p99_us / spread->p99}});
  }
  double sum_us = 0;
  for (const auto& share : bench.processor) {
    json["processor"].push_back({{"process", share.process},
                                 {"loop", json_of_threads(share.loop)},
                                 {"dds_threads", json_of_threads(share.others)}});
    sum_us += share.loop.running_us + share.others.running_us;
  }
  json["processor_us_per_tick"] = sum_us;
  return json;
}

void print(const TickBench& bench, std::ostream& out) {
  const auto json = json_of(bench);
  const auto text = [](const Json& value, int digits = 1) { return fixed(value.get<double>(), digits); };
  const auto& total = json["state_to_command_us"];
  out << "ticks " << bench.breakdown.ticks.size() << ", left out " << bench.breakdown.left_out << ", period "
      << fixed(bench.period_s * 1e3, 1) << " ms, "
      << (bench.floors.front().fifo ? "SCHED_FIFO " + std::to_string(bench.priority)
                                    : std::string{"ordinary scheduling"})
      << "\n\n";
  TextTable parts{{"state to command", "p50 us", "p99 us", "mean us", "share"}};
  for (const auto& part : json["parts"])
    parts.add({part["part"], text(part["p50_us"]), text(part["p99_us"]), text(part["mean_us"]),
               text(part["share"].get<double>() * 100) + " %"});
  parts.add({"together", text(total["p50"]), text(total["p99"]), text(total["mean"]), "100.0 %"});
  parts.print(out);

  std::vector<std::string> header{"hop, mean us"};
  header.insert(header.end(), kPartNames.begin(), kPartNames.end());
  header.emplace_back("ticks");
  TextTable hops{header};
  for (const auto& hop : json["hops"]) {
    std::vector<std::string> row{hop["from"].get<std::string>() + " -> " + hop["to"].get<std::string>()};
    for (const auto* name : kPartNames) row.push_back(text(hop["mean_us"][name]));
    row.push_back(std::to_string(hop["ticks"].get<std::size_t>()));
    hops.add(row);
  }
  out << '\n';
  hops.print(out);

  TextTable floors{{"floor of the same run", "p50 us", "p99 us", "loop / floor p50", "p99"}};
  for (std::size_t i = 0; i < bench.floors.size(); ++i) {
    const auto& floor = json["floors"][i];
    floors.add({bench.floors[i].title, text(floor["p50_us"]), text(floor["p99_us"]),
                text(floor["ratio_p50"], 2), text(floor["ratio_p99"], 2)});
  }
  out << '\n';
  floors.print(out);

  TextTable processor{{"per tick", "loop us", "waiting us", "runs", "DDS threads us", "waiting us", "runs"}};
  for (const auto& share : json["processor"])
    processor.add({share["process"], text(share["loop"]["running_us"]), text(share["loop"]["waiting_us"]),
                   text(share["loop"]["runs"]), text(share["dds_threads"]["running_us"]),
                   text(share["dds_threads"]["waiting_us"]), text(share["dds_threads"]["runs"])});
  out << '\n';
  processor.print(out);
  out << "processor time of all processes " << text(json["processor_us_per_tick"]) << " us per tick\n";
}

}  // namespace crane::cli
