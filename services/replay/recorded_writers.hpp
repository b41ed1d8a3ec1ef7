#pragma once
/// The writers of a recording outside the replayed stack: clock master, operators, and the supervisor when it
/// is not replayed. Each publishes with its recorded source and start-up number.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "crane/bus/bus.hpp"
#include "replay/recorded_run.hpp"
#include "replay/samples.hpp"

namespace crane::replay {

class RecordedWriters {
 public:
  using BusOf = std::function<bus::Bus(const std::string& name, crane_Source source, std::uint32_t epoch)>;
  /// All samples of one client come from one participant: the supervisor accepts crane/jog from the
  /// participant that requested the session.
  /// A participant announces its writers in the order of their creation: a process that answers a request has
  /// also discovered the writer of the stick.
  struct Operator {
    bus::Bus bus;
    bus::Publisher<msg::Jog> jogs;
    bus::Publisher<msg::Request> requests;
  };

  explicit RecordedWriters(BusOf bus_of) : bus_of_{std::move(bus_of)} {}

  /// Creates the writer of crane/state, before the first tick. @param first  its first sample
  void open_clock_master(const Cdr& first);
  /// @param configuration  replaces that of the sample: the replayed components have another controller, and
  ///   would report the difference. @return false when the sample is not valid or not sent
  bool publish_state(const Cdr& cdr, std::optional<std::uint32_t> configuration = std::nullopt);
  bool publish_supervisor(const Cdr& cdr);
  /// Publishes a request or a sample of crane/jog.
  bool publish_input(const Received& input);
  [[nodiscard]] Operator& operator_of(const msg::Header& header, const std::string& client);

 private:
  template <class T>
  struct Outside {
    bus::Bus bus;
    bus::Publisher<T> publisher;
  };
  template <class T>
  void open(std::unique_ptr<Outside<T>>& outside, const topics::Topic<T>& topic, const msg::Header& header);

  BusOf bus_of_;
  std::unique_ptr<Outside<msg::State>> clock_master_;
  std::unique_ptr<Outside<msg::SupervisorStatus>> supervisor_;
  std::map<std::string, Operator> operators_;
};

}  // namespace crane::replay
